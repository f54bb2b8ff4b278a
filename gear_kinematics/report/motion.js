/* Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0 */
// Moves each mechanism with its slider, its play button and the cursor of its plots. The poses are
// in page.css. A position counts samples; between them, angles are interpolated linearly.
'use strict';
(() => {
  function connect(view, figure, {time, turned, forces, layout}) {
    const [button, slider] = view.querySelectorAll('button, input');
    const speed = view.querySelector('select');
    const clock = view.querySelector('output');
    const cursor = `shapes[${layout.shapes.length - 1}]`;
    const end = time.length - 1;
    let position = slider.valueAsNumber;
    let shown = 0; // requested animation frames, if any
    let played = 0;

    function at(values) {
      const k = Math.floor(position);
      return values[k] + (position - k) * (values[Math.min(k + 1, end)] - values[k]);
    }

    function show() {
      shown = 0;
      view.style.setProperty('--rotor', `${at(turned.rotor) % 360}deg`);
      view.style.setProperty('--output', `${at(turned.output) % 360}deg`);
      view.querySelectorAll('figure').forEach((branch, k) =>
        branch.style.setProperty('--force', forces ? at(forces[k]) : 0));
      slider.value = position;
      clock.value = slider.ariaValueText = `${at(time).toFixed(4)} s`;
      Plotly.relayout(figure, {[`${cursor}.x0`]: at(time), [`${cursor}.x1`]: at(time)});
    }

    function move(to) {
      position = to;
      shown ||= requestAnimationFrame(show);
    }

    function pass(seconds) {
      let to = position;
      while (seconds > 0 && to < end) {
        const k = Math.floor(to);
        const step = time[k + 1] - time[k];
        const rest = (k + 1 - to) * step;
        to = rest > seconds ? to + seconds / step : k + 1;
        seconds -= Math.max(rest, 0); // stamps can decrease
      }
      move(to);
    }

    function play(since) {
      played = requestAnimationFrame(now => {
        pass((now - since) / 1000 * speed.value);
        if (position < end) play(now);
        else pause();
      });
      button.textContent = 'Pause';
    }

    function pause() {
      cancelAnimationFrame(played);
      played = 0;
      button.textContent = 'Play';
    }

    button.addEventListener('click', () => {
      if (played) return pause();
      if (position >= end) move(0);
      play(document.timeline.currentTime);
    });
    slider.addEventListener('input', () => move(slider.valueAsNumber));
    // Not every line has a point for each sample.
    const nearest = moment => time.reduce(
      (best, at, k) => Math.abs(at - moment) < Math.abs(time[best] - moment) ? k : best, 0);
    figure.on('plotly_hover', ({points}) => move(nearest(points[0].x)));
    figure.addEventListener('moment', ({detail}) => move(nearest(detail)));
    button.disabled = slider.disabled = false;
    return show;
  }

  const shows = new Map();
  document.addEventListener('drawn', ({target, detail}) => {
    const view = document.querySelector(`.motion[data-figure=${target.id}]`);
    if (!view) return; // a figure without a mechanism
    if (!shows.has(target)) shows.set(target, connect(view, target, detail));
    shows.get(target)();
  });
})();
