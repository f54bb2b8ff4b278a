// Shows what the server sends, and sends it what the buttons ask for. The poses of the bodies are in
// page.css.
'use strict';
(() => {
  const RETRY = 1000; // ms
  const TONES = {none: 'unusable', connecting: 'unusable', connected: 'pass', ended: 'fail'};
  const STATES = {none: 'no node', connecting: 'connecting', connected: 'connected', ended: 'ended'};
  const find = id => document.getElementById(id);
  const mechanism = find('mechanism');
  const curve = find('curve');
  const drivers = find('drivers');
  const home = find('home');
  const record = find('record');
  let server;
  let frame; // the latest one that is not shown yet
  let recording = false;
  let errors = []; // [time in s, seconds of arc]
  let listed = ''; // the drivers as they are shown

  function set(element, text, className = '') {
    if (element.textContent !== text) element.textContent = text;
    if (element.className !== className) element.className = className;
  }

  function make(tag, text = '', className = '') {
    const element = document.createElement(tag);
    set(element, text, className);
    return element;
  }

  function resize(parent, count, child) {
    while (parent.children.length > count) parent.lastElementChild.remove();
    while (parent.children.length < count) parent.append(child());
  }

  function showReadings(readings) {
    const list = find('readings');
    resize(list, readings.length, () => {
      const item = make('div');
      item.append(make('dt'), make('dd'), make('dd', '', 'detail'));
      return item;
    });
    readings.forEach(({name, value, detail, tone}, k) => {
      const [term, text, more] = list.children[k].children;
      set(term, name);
      set(text, value, tone);
      set(more, detail, 'detail');
    });
  }

  function showSentences(sentences) {
    const list = find('sentences');
    resize(list, sentences.length, () => make('li'));
    sentences.forEach(({text, tone}, k) => set(list.children[k], text, tone));
  }

  function showCurve({error, window: span}) {
    const now = performance.now() / 1000;
    if (error !== null) errors.push([now, error]);
    errors = errors.filter(([time]) => time > now - span);
    curve.hidden = errors.length < 2;
    if (curve.hidden) return;
    const values = errors.map(([, value]) => value);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const room = Math.max(high - low, 1e-3);
    const place = value => (114 - 108 * (value - low) / room).toFixed(1);
    const points = errors.map(([time, value]) => `${(600 + 600 * (time - now) / span).toFixed(1)},${place(value)}`);
    curve.querySelector('polyline').setAttribute('points', points.join(' '));
    const zero = curve.querySelector('line');
    zero.setAttribute('y1', place(0));
    zero.setAttribute('y2', place(0));
    set(curve.querySelector('figcaption'),
      `transmission error of the last ${span} s: ${low.toFixed(1)}″ to ${high.toFixed(1)}″`);
  }

  function showDrivers(found, open) {
    const rows = found.flatMap(({topic, joints, rate, publishers}) =>
      (joints.length ? joints : ['']).map(joint => ({topic, joint, rate, publishers})));
    const body = drivers.querySelector('tbody');
    const names = JSON.stringify(rows.map(({topic, joint}) => [topic, joint]));
    if (names !== listed) {
      if (!listed) drivers.open = open;
      listed = names;
      body.replaceChildren(...rows.map(({topic, joint}) => {
        const row = make('tr');
        const last = make('td');
        row.append(make('td', joint, 'words'), make('td', topic, 'words'), make('td', '', 'number'), last);
        if (joint) {
          const button = make('button', 'Write config');
          button.type = 'button';
          button.setAttribute('aria-label', `Write config for joint ${joint} on ${topic}`);
          button.addEventListener('click', () => send({do: 'configure', topic, joint}));
          last.append(button);
        }
        return row;
      }));
    }
    rows.forEach(({rate, publishers}, k) => {
      const several = publishers > 1 ? `, ${publishers} drivers` : '';
      set(body.children[k].children[2], `${rate.toFixed(0)} Hz${several}`, 'number');
    });
  }

  function show() {
    const now = frame;
    frame = undefined;
    if (!now) return;
    if (now.rotor !== null) {
      mechanism.style.setProperty('--rotor', `${now.rotor}deg`);
      mechanism.style.setProperty('--output', `${now.output}deg`);
    }
    recording = now.recording !== '';
    set(find('node'), now.node);
    set(find('state'), STATES[now.state], `badge ${TONES[now.state]}`);
    set(find('words'), now.words);
    set(find('recording'), now.recording ? `Recording to ${now.recording}` : now.failure,
      now.recording ? 'on' : 'bad');
    set(record, recording ? 'Stop recording' : 'Record', recording ? 'on' : '');
    home.disabled = now.state !== 'connected' || recording;
    record.disabled = !recording && now.state !== 'connected' && !now.drivers.length;
    showReadings(now.readings);
    showSentences(now.sentences);
    showCurve(now);
    showDrivers(now.drivers, now.state === 'none');
    document.body.classList.toggle('old', now.state !== 'connected');
    document.body.classList.toggle('none', now.state === 'none');
  }

  function send(command) {
    if (server.readyState === WebSocket.OPEN) server.send(JSON.stringify(command));
  }

  function connect() {
    server = new WebSocket(`${location.href.replace(/^http/, 'ws').replace(/[^/]*$/, '')}live`);
    server.addEventListener('message', ({data}) => {
      const message = JSON.parse(data);
      if ('drawing' in message) mechanism.innerHTML = message.drawing;
      if ('answer' in message) set(find('answer'), message.answer.text, message.answer.done ? '' : 'bad');
      if ('view' in message) {
        if (!frame) requestAnimationFrame(show);
        frame = message.view;
      }
    });
    server.addEventListener('close', () => {
      set(find('state'), 'no connection', 'badge fail');
      set(find('words'), 'gearkin watch has ended, or cannot be reached. Trying again.');
      home.disabled = record.disabled = true;
      document.body.classList.add('old');
      setTimeout(connect, RETRY);
    });
  }

  home.addEventListener('click', () => send({do: 'home'}));
  record.addEventListener('click', () => send({do: recording ? 'stop' : 'record'}));
  connect();
})();
