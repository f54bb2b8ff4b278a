/* Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0 */
// Shows what the server sends, and sends it what the buttons ask for; page.css poses the bodies.
'use strict';
(() => {
  const RETRY = 1000; // ms
  const SPAN = 10; // s of the curve
  const find = id => document.getElementById(id);
  const [nodes, mechanism, home, question, undo, commission, guide] =
    ['nodes', 'mechanism', 'home', 'question', 'undo', 'commission', 'guide'].map(find);
  const form = commission.querySelector('form');
  let server;
  let revision = 0; // of what is shown, which commands answer
  let asked = 0; // the revision that the question is about
  let points = []; // [time in s, output angle in degrees or null]

  function set(element, text, className = '') {
    if (element.textContent !== text) element.textContent = text;
    if (element.className !== className) element.className = className;
  }

  function showEntries(list, entries) {
    while (list.children.length > entries.length) list.lastElementChild.remove();
    while (list.children.length < entries.length) {
      list.insertAdjacentHTML('beforeend', '<div><dt></dt><dd></dd><dd></dd></div>');
    }
    entries.forEach(({name, value, detail, tone}, k) => {
      const [title, text, more] = list.children[k].children;
      set(title, name);
      set(text, value, tone);
      set(more, detail, 'detail');
    });
  }

  function showCurve(angle) {
    const now = performance.now() / 1000;
    points = [...points.filter(([time]) => time > now - SPAN), [now, angle]];
    const known = points.map(([, value]) => value).filter(value => value !== null);
    find('curve').hidden = !known.length;
    if (!known.length) return;
    const [low, high] = [Math.min(...known), Math.max(...known)];
    const scale = 88 / Math.max(high - low, 1e-3);
    const height = value => (50 - scale * (value - (low + high) / 2)).toFixed(1);
    const path = points.map(([time, value], k) => value === null ? '' :
      `${(points[k - 1]?.[1] ?? null) === null ? 'M' : 'L'}` +
      `${(300 + 300 * (time - now) / SPAN).toFixed(1)},${height(value)}`);
    find('curve').querySelector('path').setAttribute('d', path.join(''));
    const [least, greatest] = [low, high].map(value => value.toFixed(1).replace('-0.0', '0.0'));
    set(find('curve').firstElementChild, `output angle, ${SPAN} s: ${least} to ${greatest}°`);
  }

  function showJoints(joints) {
    const keys = joints.map(channel => JSON.stringify(channel));
    if (guide.hidden) commission.hidden = keys.length < 2;
    [form.rotor, form.output].forEach((select, k) => {
      if (select.dataset.keys === String(keys)) return;
      const chosen = keys.includes(select.value) ? select.value : keys[k] ?? '';
      select.replaceChildren(...joints.map(([topic, joint], n) =>
        new Option(`${joint} on ${topic}`, keys[n])));
      [select.value, select.dataset.keys] = [chosen, String(keys)];
    });
  }

  function showNodes(found, node) {
    const texts = found.map(({name, value}) => `${name}: ${value}`);
    nodes.hidden = found.every(({name}) => name === node);
    if (nodes.dataset.texts !== String(texts)) {
      nodes.replaceChildren(...texts.map((text, k) => new Option(text, found[k].name)));
      nodes.dataset.texts = texts;
    }
    if (nodes.value !== node) nodes.value = node;
    set(find('node'), nodes.hidden ? texts[0] ?? node : '');
  }

  function showGuide(now) {
    guide.hidden = !now;
    set(form.querySelector('button'), now ? 'Change' : 'Start');
    if (!now) return;
    set(guide.firstElementChild, now.advice, now.known === 1 ? 'pass' : '');
    guide.querySelector('progress').value = now.known;
    showEntries(guide.querySelector('dl'), now.entries);
  }

  function showState(state, tone, message) {
    document.body.className = state.replace(' ', '-');
    set(find('state'), state, `badge ${tone}`);
    set(find('message'), message);
  }

  function show(now) {
    if (now.revision !== revision) points = []; // they were of another gear or zero
    revision = now.revision;
    if (asked !== revision) question.close();
    if (now.rotor !== null) {
      for (const name of ['rotor', 'output']) {
        mechanism.style.setProperty(`--${name}`, `${now[name] % 360}deg`);
      }
    }
    find('margin').hidden = now.margin === null;
    find('margin').lastElementChild.value = now.margin ?? 0;
    showState(now.state, now.tone, now.message);
    showNodes(now.nodes, now.node);
    allow(now.question, now.undo);
    showEntries(find('arm'), now.arm);
    showEntries(find('values'), now.values);
    showEntries(find('diagnostics'), now.diagnostics);
    showCurve(now.output);
    showEntries(find('drivers').lastElementChild, now.drivers);
    showJoints(now.joints);
    showGuide(now.guide);
  }

  function allow(homing, undoing) {
    home.disabled = !homing;
    undo.hidden = !undoing;
    set(undo.lastElementChild, `back to ${undoing}`);
    if (homing) set(question.querySelector('p'), homing);
    else question.close();
  }

  function showAnswer({text, done}) {
    set(find('answer'), text, done ? '' : 'bad');
  }

  function send(message) {
    if (server.readyState === WebSocket.OPEN) server.send(JSON.stringify({revision, ...message}));
  }

  function connect() {
    server = new WebSocket(`${location.href.replace(/^http/, 'ws').replace(/[^/]*$/, '')}live`);
    server.addEventListener('message', ({data}) => {
      const message = JSON.parse(data);
      if ('drawing' in message) mechanism.innerHTML = message.drawing;
      if ('answer' in message) showAnswer(message.answer);
      if ('view' in message) show(message.view);
    });
    server.addEventListener('close', () => {
      showState('no connection', 'fail', 'gearkin watch has ended, or cannot be reached. Trying again.');
      allow('', '');
      setTimeout(connect, RETRY);
    });
  }

  home.addEventListener('click', () => {
    showAnswer({text: '', done: true});
    asked = revision;
    question.showModal(); // Cancel is focused: a key held down homes nothing
  });
  // Browsers tell of a closed dialog only with the next frame, and then of each time that it was closed.
  question.firstElementChild.addEventListener('submit', ({submitter}) =>
    submitter.value && send({do: 'home', revision: asked}));
  undo.firstElementChild.addEventListener('click', () => send({do: 'undo'}));
  nodes.addEventListener('change', () => send({do: 'show', node: nodes.value}));
  form.addEventListener('submit', event => {
    event.preventDefault();
    const [rotor, output] = [form.rotor, form.output].map(select => JSON.parse(select.value));
    send({do: 'commission', rotor, output, ratio: form.ratio.value, zero: form.zero.value});
  });
  guide.addEventListener('click', ({target}) => target.value && send({do: target.value, actuator: form.actuator.value}));
  connect();
})();
