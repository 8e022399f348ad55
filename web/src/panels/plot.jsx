// One plot of a few signals over the span of time that is looked at. Click to look at a time, drag to zoom, double
// click for everything again; bands show the states of the behavior that moved last.
import { useLayoutEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import { bucket_times, bucket_values } from '../data/buckets.js';
import { number, useSession, useShown } from '../watching.js';
import { dragged_signal } from './signal_list.jsx';

export const line_colors = ['#2f7fd1', '#d9772b', '#2f9e6e', '#b8479b', '#8a6fd1', '#c2a01e', '#4aa3a8', '#d1495b'];
const inks = {
  light: { text: '#5b6875', grid: '#e3e8ec', band: 'rgba(30,60,90,0.045)' },
  dark: { text: '#93a1af', grid: '#252e37', band: 'rgba(200,220,255,0.045)' },
};

// Every other state is shaded: where one ends the next begins.
function draw_bands(plot, session, color) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.fillStyle = color;
  const edges = [session.start_s, ...session.transitions.map((entry) => entry.t), session.end_s];
  for (let i = 1; i + 1 < edges.length; i += 2) {
    const left = Math.max(bbox.left, plot.valToPos(edges[i], 'x', true));
    const right = Math.min(bbox.left + bbox.width, plot.valToPos(edges[i + 1], 'x', true));
    if (right > left) ctx.fillRect(left, bbox.top, right - left, bbox.height);
  }
  ctx.restore();
}

// A little air above and below; what does not change stands in the middle.
function y_range(_, low, high) {
  if (low === null || !Number.isFinite(low)) return [0, 1];
  const air = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? 0.06 * (high - low) : Math.max(0.05 * Math.abs(high), 0.01);
  return [low - air, high + air];
}

function options_for({ session, names, theme, size, zoom }) {
  const ink = inks[theme];
  const axis = { stroke: ink.text, grid: { stroke: ink.grid, width: 1 }, ticks: { show: false }, font: '11px system-ui' };
  return {
    ...size,
    legend: { show: false },
    padding: [8, 10, 0, 0],
    cursor: { drag: { x: true, y: false, setScale: false }, points: { show: false }, y: false },
    scales: { x: { time: false }, y: { range: y_range } },
    axes: [
      { ...axis, size: 24, values: (_, ticks) => ticks.map((tick) => `${number(tick, 6)}`) },
      { ...axis, size: 58, space: 26, values: (_, ticks) => ticks.map((tick) => number(tick, 4)) },
    ],
    series: [{}, ...names.map((_, i) => ({ stroke: line_colors[i % line_colors.length], width: 1.4, spanGaps: true, points: { show: false } }))],
    hooks: {
      drawClear: [(plot) => draw_bands(plot, session, ink.band)],
      setSelect: [
        (plot) => {
          if (plot.select.width < 4) return;
          const from = plot.posToVal(plot.select.left, 'x');
          zoom([from, plot.posToVal(plot.select.left + plot.select.width, 'x')]);
          plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        },
      ],
      ready: [
        (plot) => {
          let pressed = 0;
          plot.over.addEventListener('mousedown', (event) => (pressed = event.clientX));
          plot.over.addEventListener('mouseup', (event) => {
            if (Math.abs(event.clientX - pressed) < 4) session.seek(plot.posToVal(event.offsetX, 'x'));
          });
          plot.over.addEventListener('dblclick', () => zoom(null));
        },
      ],
    },
  };
}

function data_of(session, names, [from, to], width) {
  const buckets = Math.max(50, Math.min(2000, Math.floor(width)));
  const columns = names.map((name) => {
    const signal = session.signals.get(name);
    return signal && to > from ? bucket_values(signal, from, to, buckets) : new Array(2 * buckets).fill(null);
  });
  return [bucket_times(from, to, buckets), ...columns];
}

function Legend({ session, names, remove, close }) {
  useSession(session, 10);
  return (
    <header>
      {names.map((name, i) => (
        <span class="series" key={name} title={session.signals.get(name)?.doc}>
          <i style={{ background: line_colors[i % line_colors.length] }} />
          {name}
          <b>{number(session.value(name))}</b>
          <small>{session.signals.get(name)?.unit}</small>
          <button aria-label={`Remove ${name}`} onClick={() => remove(name)}>×</button>
        </span>
      ))}
      <button class="close" aria-label="Close plot" onClick={close}>×</button>
    </header>
  );
}

export function Plot({ session, names, span, zoom, theme, frames, change, close }) {
  const host = useRef();
  const line = useRef();
  const shown = useShown({ span, zoom });
  const key = `${names.join()} ${theme}`;
  // A layout effect: what is drawn has the names that the page shows, in every frame.
  useLayoutEffect(() => {
    const size = () => ({ width: host.current.clientWidth, height: host.current.clientHeight });
    const options = options_for({ session, names, theme, size: size(), zoom: (range) => shown.current.zoom(range) });
    const plot = new uPlot(options, [[], ...names.map(() => [])], host.current);
    let drawn = '';
    const draw = () => {
      const { width, height } = size();
      if (width < 40 || height < 40) return;
      const [from, to] = shown.current.span();
      const sign = `${from.toFixed(3)} ${to.toFixed(3)} ${width} ${height} ${session.version} ${session.title}`;
      if (sign !== drawn) {
        drawn = sign;
        if (plot.width !== width || plot.height !== height) plot.setSize({ width, height });
        plot.setData(data_of(session, names, [from, to], width), false);
        plot.setScale('x', { min: from, max: to > from ? to : from + 1 });
      }
      const left = plot.valToPos(session.cursor_s, 'x');
      const inside = left >= 0 && left <= plot.over.clientWidth;
      line.current.style.display = inside ? '' : 'none';
      line.current.style.transform = `translateX(${plot.over.offsetLeft + left}px)`;
    };
    const leave = frames.add(draw);
    return () => {
      leave();
      plot.destroy();
    };
  }, [key, session]);
  const remove = (name) => (names.length > 1 ? change(names.filter((other) => other !== name)) : close());
  return (
    <article
      class="plot"
      onDragOver={(event) => event.preventDefault()}
      onDrop={(event) => {
        const name = dragged_signal(event);
        event.preventDefault();
        event.stopPropagation();
        if (session.signals.has(name) && !names.includes(name)) change([...names, name]);
      }}
    >
      <Legend {...{ session, names, remove, close }} />
      <div class="canvas" ref={host}><div class="now" ref={line} /></div>
    </article>
  );
}
