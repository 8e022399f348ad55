// The keys of the page; they rest while somebody types.
export const keys = [
  ['space', 'Play or pause'],
  ['← →', '10 ms back or on; with shift 1 s'],
  ['Home End', 'Begin or end'],
  ['[ ]', 'Transition before or after'],
  ['1 … 6', 'Behavior, parameters, safety, timing, log, world'],
  ['/', 'Find a signal'],
  ['f', 'Look at the robot from the start again'],
  ['t', 'Dark or light'],
  ['?', 'These keys'],
];

function step_transition(session, direction) {
  const margin_s = 1e-3;
  const times = session.transitions.map((entry) => entry.t);
  const next = direction > 0 ? times.find((t) => t > session.cursor_s + margin_s) : times.findLast((t) => t < session.cursor_s - margin_s);
  if (next !== undefined) session.seek(next);
}

// `page`: {session(), tab(i), find(), look(), theme(), help()}.
export function listen_to_keys(page) {
  const move = (dt_s) => {
    const session = page.session();
    session.playing = false;
    session.seek(session.cursor_s + dt_s);
  };
  const actions = {
    ' ': () => page.session().toggle_play(),
    ArrowLeft: (event) => move(event.shiftKey ? -1 : -0.01),
    ArrowRight: (event) => move(event.shiftKey ? 1 : 0.01),
    Home: () => page.session().seek(page.session().start_s),
    End: () => page.session().seek(page.session().end_s),
    '[': () => step_transition(page.session(), -1),
    ']': () => step_transition(page.session(), 1),
    '/': () => page.find(),
    f: () => page.look(),
    t: () => page.theme(),
    '?': () => page.help(),
  };
  const listener = (event) => {
    const typing = event.target.closest?.('input, select, textarea') && event.target.type !== 'range';
    if (event.key === 'Escape') return page.help(false), document.activeElement?.blur();
    if (typing || event.ctrlKey || event.metaKey || event.altKey) return;
    if (/^[1-5]$/.test(event.key)) return page.tab(Number(event.key) - 1);
    const slider = event.target.type === 'range';
    const button = event.target.closest?.('button') && event.key === ' ';
    if (!actions[event.key] || (slider && event.key.startsWith('Arrow')) || button) return;
    event.preventDefault();
    actions[event.key](event);
  };
  addEventListener('keydown', listener);
  return () => removeEventListener('keydown', listener);
}
