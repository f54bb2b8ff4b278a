// Draws each figure when it comes into view: the page of a fleet has hundreds.
'use strict';
(() => {
  const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const figures = new Map();
  const phone = matchMedia('(max-width: 40rem)');

  // On a phone, panels that would be side by side are below each other, and texts have more lines.
  function fitted(element, {time, layout}) {
    const panels = Object.keys(layout).filter(name => name.startsWith('yaxis'));
    element.style.height = '';
    if (!phone.matches) return layout;
    const fits = {...layout};
    const wrapped = text => text?.length > 40 ? text.replace(/(.{20,38}) /g, '$1<br>') : text;
    fits.annotations = layout.annotations.map(note => ({...note, text: wrapped(note.text)}));
    for (const name of Object.keys(layout).filter(name => name.startsWith('xaxis'))) {
      fits[name] = {...layout[name], title: {text: wrapped(layout[name].title.text)}};
    }
    if (time || panels.length < 2) return fits;
    element.style.height = `${20 * panels.length}rem`;
    panels.forEach((name, k) => {
      const top = 1 - k / panels.length;
      fits[name] = {...layout[name], domain: [top - 0.65 / panels.length, top]};
      const across = name.replace('y', 'x');
      fits[across] = {...fits[across], domain: [0, 1]};
    });
    return fits;
  }

  function draw(element) {
    const figure = figures.get(element);
    const {time, data} = figure;
    const layout = fitted(element, figure);
    const grid = {gridcolor: colour('--rule'), linecolor: colour('--rule'), zerolinecolor: colour('--faint')};
    const themed = {
      ...layout,
      paper_bgcolor: 'rgba(0,0,0,0)',
      plot_bgcolor: 'rgba(0,0,0,0)',
      font: {color: colour('--text'), family: 'system-ui, sans-serif', size: 12},
      hoverlabel: {bgcolor: colour('--raised'), font: {color: colour('--text')}},
      hovermode: layout.hovermode ?? 'x unified',
      hoversubplots: 'axis',
      margin: {l: 90, r: 20, t: phone.matches && layout.showlegend ? 90 : 55, b: phone.matches ? 65 : 50},
      modebar: {bgcolor: 'rgba(0,0,0,0)', color: colour('--faint'), activecolor: colour('--text')},
      showlegend: layout.showlegend ?? false,
      shapes: layout.shapes.map(({meta = 'fail', ...shape}) => ({
        ...shape,
        line: {color: colour('--' + meta), dash: 'dash', width: 1, ...shape.line},
        label: {...shape.label, font: {color: colour('--' + meta), size: 11}},
      })),
    };
    for (const name of Object.keys(layout)) {
      if (name.includes('axis')) themed[name] = {...grid, ...layout[name]};
    }
    const traces = data.map(trace => ({
      ...trace, x: trace.x ?? time, type: 'scatter', mode: trace.mode ?? 'lines',
      line: {color: colour('--' + trace.meta), width: 1.5, ...trace.line},
      marker: {color: colour('--' + trace.meta), ...trace.marker},
      error_y: trace.error_y && {color: colour('--' + trace.meta), ...trace.error_y},
    }));
    // Only these buttons: some others would send the data to a server.
    const buttons = [['toImage'], ['zoom2d', 'pan2d', 'resetScale2d']];
    const config = {responsive: true, displaylogo: false, modeBarButtons: buttons};
    Plotly.react(element, traces, themed, config);
    element.dispatchEvent(new CustomEvent('drawn', {bubbles: true, detail: figure}));
  }

  const seen = new IntersectionObserver(entries => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      seen.unobserve(entry.target);
      draw(entry.target);
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
    const {time} = figures.get(element);
    const moment = Number(link.dataset.time);
    const known = time.filter(at => at !== null);
    const around = (Math.max(...known) - Math.min(...known)) / 40 || 1;
    Plotly.relayout(element, {'xaxis.range': [moment - around, moment + around]});
    element.dispatchEvent(new CustomEvent('moment', {detail: moment}));
  });
})();
