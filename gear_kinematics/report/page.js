// Draws each figure when it comes into view: the page of a fleet has hundreds.
'use strict';
(() => {
  const figures = new Map();
  const phone = matchMedia('(max-width: 40rem)');
  const probe = document.body.appendChild(document.createElement('i'));

  function colour(name) { // of the style sheet, in the present scheme
    probe.style.color = `var(--${name})`;
    return getComputedStyle(probe).color;
  }

  // On a phone, panels that would be side by side are below each other, and texts have more lines.
  function fit(element, {time, layout}) {
    element.style.height = '';
    if (!phone.matches) return layout;
    const fitted = structuredClone(layout);
    const panels = Object.keys(layout).filter(name => name.startsWith('yaxis'));
    const titles = Object.keys(layout).filter(name => name.startsWith('xaxis')).map(name => fitted[name].title);
    for (const item of [...fitted.annotations, ...titles]) {
      if (item.text.length > 40) item.text = item.text.replace(/(.{20,38}) /g, '$1<br>');
    }
    if (time || panels.length < 2) return fitted;
    element.style.height = `${20 * panels.length}rem`;
    panels.forEach((name, k) => {
      fitted[name].domain = [1 - (k + 0.65) / panels.length, 1 - k / panels.length];
      fitted[name.replace('y', 'x')].domain = [0, 1];
    });
    return fitted;
  }

  function draw(element) {
    const figure = figures.get(element);
    const layout = fit(element, figure);
    const axis = {
      gridcolor: colour('rule'), showline: true, linecolor: colour('rule'), zerolinecolor: colour('faint'),
    };
    const themed = {
      ...layout,
      template: {layout: {xaxis: axis, yaxis: axis}},
      paper_bgcolor: 'rgba(0,0,0,0)',
      plot_bgcolor: 'rgba(0,0,0,0)',
      font: {color: colour('text'), family: 'system-ui, sans-serif', size: 12},
      hoverlabel: {bgcolor: colour('raised'), font: {color: colour('text')}},
      hoversubplots: 'axis',
      margin: {l: 90, r: 20, t: phone.matches && layout.showlegend ? 90 : 55, b: phone.matches ? 65 : 50},
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
      error_y: trace.error_y && {color: colour(meta), ...trace.error_y},
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
  for (const query of [matchMedia('(prefers-color-scheme: dark)'), phone]) {
    query.addEventListener('change', () => {
      for (const element of figures.keys()) if (element.data) draw(element);
    });
  }
  addEventListener('beforeprint', () => {
    for (const folded of document.querySelectorAll('details')) folded.open = true;
    for (const element of figures.keys()) if (!element.data) draw(element);
  });

  // Findings lead to their moment: the time axis shows it with a twentieth of the whole around it.
  document.addEventListener('click', ({target}) => {
    const link = target.closest('a[data-time]');
    if (!link) return;
    const element = document.getElementById(link.hash.slice(1));
    if (!element.data) draw(element);
    const moment = Number(link.dataset.time);
    const known = figures.get(element).time.filter(at => at !== null);
    const around = (Math.max(...known) - Math.min(...known)) / 40 || 1;
    Plotly.relayout(element, {'xaxis.range': [moment - around, moment + around]});
    element.dispatchEvent(new CustomEvent('moment', {detail: moment}));
  });
})();
