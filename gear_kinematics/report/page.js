/* Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0 */
// Draws each plot when it comes into view: the page of a fleet has hundreds.
'use strict';
(() => {
  const figures = new Map();
  const probe = document.body.appendChild(document.createElement('i'));

  function colour(name) { // of the style sheet, in the present scheme
    probe.style.color = `var(--${name})`;
    return getComputedStyle(probe).color;
  }

  function draw(element) {
    const figure = figures.get(element);
    const {layout} = figure;
    const axis = {
      gridcolor: colour('rule'), showline: true, linecolor: colour('rule'), zerolinecolor: colour('faint'),
      automargin: true, tickformat: '.8~g',
    };
    const themed = {
      ...layout,
      template: {layout: {xaxis: axis, yaxis: axis}},
      paper_bgcolor: 'rgba(0,0,0,0)',
      plot_bgcolor: 'rgba(0,0,0,0)',
      font: {color: colour('text'), family: 'system-ui, sans-serif', size: 12},
      hoverlabel: {bgcolor: colour('raised'), font: {color: colour('text')}},
      hoversubplots: 'axis',
      margin: {l: 20, r: 20, t: 30, b: 20},
      modebar: {bgcolor: 'rgba(0,0,0,0)', color: colour('faint'), activecolor: colour('text')},
      shapes: layout.shapes.map(({meta, line, label, ...shape}) => ({
        ...shape,
        line: {color: colour(meta), width: 1, ...line},
        label: {...label, font: {color: colour(meta), size: 11}},
      })),
    };
    const traces = figure.data.map(({meta, ...trace}) => ({
      x: figure.time, type: 'scatter', mode: 'lines', ...trace,
      line: {color: colour(meta), width: 1.5, ...trace.line},
      marker: {color: colour(meta), ...trace.marker},
    }));
    // Only these buttons: some others would send the data to a server.
    const buttons = [['toImage'], ['zoom2d', 'pan2d', 'resetScale2d']];
    const config = {responsive: true, displaylogo: false, modeBarButtons: buttons};
    Plotly.react(element, traces, themed, config);
    element.dispatchEvent(new CustomEvent('drawn', {bubbles: true, detail: figure}));
  }

  const seen = new IntersectionObserver(entries => {
    for (const {target, isIntersecting} of entries) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      draw(target);
    }
  }, {rootMargin: '400px'});

  for (const script of document.querySelectorAll('script[data-figure]')) {
    const element = document.getElementById(script.dataset.figure);
    figures.set(element, JSON.parse(script.textContent));
    seen.observe(element);
  }
  addEventListener('beforeprint', () => {
    for (const folded of document.querySelectorAll('details')) folded.open = true;
    for (const element of figures.keys()) if (!element.data) draw(element);
  });

  document.addEventListener('click', ({target}) => {
    const link = target.closest('a[data-time]');
    if (link) show(document.getElementById(link.hash.slice(1)), Number(link.dataset.time));
  });

  // Findings lead to their moment: the time axis shows it with a twentieth of the whole around it.
  function show(element, moment) {
    if (!element.data) draw(element);
    const known = figures.get(element).time.filter(at => at !== null);
    const around = (Math.max(...known) - Math.min(...known)) / 40 || 1;
    Plotly.relayout(element, {'xaxis.range': [moment - around, moment + around]});
    element.dispatchEvent(new CustomEvent('moment', {detail: moment}));
  }
})();
