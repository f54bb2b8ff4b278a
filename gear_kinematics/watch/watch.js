/* Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0 */
// Shows what the server sends, and sends it what the buttons ask for; page.css poses the bodies.
'use strict';
(() => {
  const RETRY = 1000; // ms
  const SPAN = 10; // s of a curve
  const find = id => document.getElementById(id);
  const [mechanism, drivers, home, record, command, question, undo, commission, guide] =
    ['mechanism', 'drivers', 'home', 'record', 'command', 'question', 'undo', 'commission', 'guide'].map(find);
  const form = commission.querySelector('form');
  let server;
  let frame; // the latest one that is not shown yet
  let recording = false;
  const curves = {}; // [time in s, value or null] by name

  function set(element, text, className = '') {
    if (element.textContent !== text) element.textContent = text;
    if (element.className !== className) element.className = className;
  }

  function fill(parent, ...texts) {
    texts.forEach(([text, className], k) => set(parent.children[k], text, className));
  }

  function make(tag, ...children) {
    const element = document.createElement(tag);
    element.append(...children);
    return element;
  }

  function resize(parent, count, child) {
    while (parent.children.length > count) parent.lastElementChild.remove();
    while (parent.children.length < count) parent.append(child());
  }

  function showEntries(list, entries) {
    resize(list, entries.length, () => make('div', make('dt'), make('dd'), make('dd')));
    entries.forEach(({name, value, detail, tone}, k) => fill(list.children[k], [name], [value, tone],
      [detail, 'detail']));
  }

  function showCurve(figure, {name, curve: [unit, value]}) {
    const now = performance.now() / 1000;
    const points = (curves[name] ?? []).filter(([time]) => time > now - SPAN);
    points.push([now, value]);
    curves[name] = points;
    const values = points.map(([, known]) => known).filter(known => known !== null);
    const [low, high] = values.length ? [Math.min(...values), Math.max(...values)] : [0, 0];
    const scale = 88 / Math.max(high - low, 1e-3);
    const height = known => (50 - scale * (known - (low + high) / 2)).toFixed(1);
    const path = points.map(([time, known], k) => known === null ? '' :
      `${(points[k - 1]?.[1] ?? null) === null ? 'M' : 'L'}` +
      `${(300 + 300 * (time - now) / SPAN).toFixed(1)},${height(known)}`);
    figure.querySelector('path').setAttribute('d', path.join(''));
    for (const end of ['y1', 'y2']) figure.querySelector('line').setAttribute(end, height(0));
    fill(figure.firstElementChild, [`${name}, ${SPAN} s`],
      [values.length ? `${low.toFixed(1)} to ${high.toFixed(1)}${unit}` : 'no values']);
  }

  function driverRow() {
    const button = make('button', 'Write config');
    const row = make('tr', make('td'), make('td'), make('td'), make('td', button));
    button.addEventListener('click', () => send({do: 'configure', ...row.driver}));
    return row;
  }

  function showDrivers(found) {
    const rows = found.flatMap(({joints, ...more}) =>
      (joints.length ? joints : ['']).map(joint => ({joint, ...more})));
    const body = drivers.querySelector('tbody');
    resize(body, rows.length, driverRow);
    rows.forEach(({topic, joint, rate, publishers}, k) => {
      const row = body.children[k];
      const button = row.querySelector('button');
      row.driver = {topic, joint};
      fill(row, [joint, 'words'], [topic, 'words'],
        [`${rate.toFixed(0)} Hz${publishers > 1 ? `, ${publishers} drivers` : ''}`, 'number']);
      button.hidden = !joint;
      button.setAttribute('aria-label', `Write config for joint ${joint} on ${topic}`);
    });
  }

  function showJoints(found) {
    const joints = found.flatMap(({topic, joints}) => joints.map(joint => [topic, joint]));
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

  function showCommission(now) {
    const button = form.querySelector('button');
    guide.hidden = !now;
    set(button, now ? 'Change' : 'Start');
    if (!now) return;
    fill(guide, [now.advice, now.known === 1 ? 'pass' : '']);
    guide.querySelector('progress').value = now.known;
    set(guide.querySelector('.detail'), now.heard, 'detail');
    showEntries(guide.querySelector('dl'), now.entries);
  }

  function showState(state, tone, duration, message) {
    const name = state.replace(' ', '-');
    if (document.body.className !== name) {
      document.body.className = name;
      drivers.open = state === 'no node'; // there it is what matters
    }
    set(find('state'), state, `badge ${tone}`);
    set(find('duration'), duration);
    set(find('message'), message);
  }

  function show() {
    const now = frame;
    frame = undefined;
    if (!now) return;
    if (now.rotor !== null) {
      for (const name of ['rotor', 'output']) mechanism.style.setProperty(`--${name}`, `${now[name]}deg`);
    }
    recording = now.recording !== '';
    const running = !['no node', 'connecting', 'ended'].includes(now.state);
    showState(now.state, now.tone, now.duration, now.message);
    set(find('node'), now.node);
    set(find('recording'), now.recording ? `Recording to ${now.recording}` : now.failure,
      now.recording ? '' : 'bad');
    set(record, recording ? 'Stop recording' : 'Record', recording ? 'on' : '');
    home.disabled = !now.question;
    undo.hidden = !now.undo;
    set(undo.lastElementChild, `sets ${now.undo} again`);
    if (home.disabled) question.hidden = true;
    else fill(question, [now.question]);
    record.disabled = !recording && !running && !now.drivers.length;
    showEntries(find('values'), now.values);
    showEntries(find('diagnostics'), now.diagnostics);
    const shown = now.values.filter(({curve}) => curve);
    resize(find('curves'), shown.length,
      () => find('curve').content.firstElementChild.cloneNode(true));
    shown.forEach((entry, k) => showCurve(find('curves').children[k], entry));
    showDrivers(now.drivers);
    showJoints(now.drivers);
    showCommission(now.commission);
  }

  function showAnswer({text, done, command: line}) {
    set(find('answer'), text, done ? '' : 'bad');
    fill(command, [line], ['Copy']);
    command.hidden = !line;
  }

  function send(message) {
    if (server.readyState === WebSocket.OPEN) server.send(JSON.stringify(message));
  }

  function connect() {
    server = new WebSocket(`${location.href.replace(/^http/, 'ws').replace(/[^/]*$/, '')}live`);
    server.addEventListener('message', ({data}) => {
      const message = JSON.parse(data);
      if ('drawing' in message) mechanism.innerHTML = message.drawing;
      if ('answer' in message) showAnswer(message.answer);
      if ('view' in message) {
        if (!frame) requestAnimationFrame(show);
        frame = message.view;
      }
    });
    server.addEventListener('close', () => {
      showState('no connection', 'fail', '', 'gearkin watch has ended, or cannot be reached. Trying again.');
      home.disabled = record.disabled = question.hidden = undo.hidden = true;
      setTimeout(connect, RETRY);
    });
  }

  const [, cancel, confirm] = question.children;

  function ask(asking) {
    question.hidden = !asking;
    if (asking) showAnswer({text: '', done: true});
    (asking ? cancel : home).focus(); // a key held down homes nothing
  }

  home.addEventListener('click', () => ask(true));
  cancel.addEventListener('click', () => ask(false));
  confirm.addEventListener('click', () => {
    ask(false);
    send({do: 'home'});
  });
  question.addEventListener('keydown', ({key}) => {
    if (key === 'Escape') ask(false);
  });
  undo.firstElementChild.addEventListener('click', () => send({do: 'undo'}));
  record.addEventListener('click', () => send({do: recording ? 'stop' : 'record'}));
  form.addEventListener('submit', event => {
    event.preventDefault();
    const [rotor, output] = [form.rotor, form.output].map(select => JSON.parse(select.value));
    send({do: 'commission', rotor, output, ratio: form.ratio.value});
  });
  guide.addEventListener('click', ({target}) => target.value && send({do: target.value}));
  command.querySelector('button').addEventListener('click', async ({target}) => {
    await navigator.clipboard.writeText(command.querySelector('code').textContent);
    set(target, 'Copied');
  });
  connect();
})();
