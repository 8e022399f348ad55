// The page: robot and plots in the middle, signals on the left, one of six panels on the right, time below.
import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { active_paths } from './data/active_states.js';
import { keep, kept } from './data/kept.js';
import { keys, listen_to_keys } from './keyboard.js';
import { BehaviorPanel } from './panels/behavior_panel.jsx';
import { LogPanel } from './panels/log_panel.jsx';
import { ParametersPanel } from './panels/parameters_panel.jsx';
import { Plots } from './panels/plots.jsx';
import { RobotPanel } from './panels/robot_panel.jsx';
import { rungs, SafetyPanel } from './panels/safety_panel.jsx';
import { ScrubBar } from './panels/scrub_bar.jsx';
import { SignalList } from './panels/signal_list.jsx';
import { TimingPanel } from './panels/timing_panel.jsx';
import { TopBar } from './panels/top_bar.jsx';
import { WorldPanel } from './panels/world_panel.jsx';
import { useSession, useShown } from './watching.js';

const tabs = [['Behavior', BehaviorPanel], ['Parameters', ParametersPanel], ['Safety', SafetyPanel], ['Timing', TimingPanel], ['Log', LogPanel], ['World', WorldPanel]];

// What is plotted first: of a robot on feet, of one that looks, else the joints.
function first_plots(session) {
  const joints = (session.description?.robot.joints ?? []).slice(0, 2);
  const wanted = session.description?.robot.feet.length === 0
    ? [['control.gaze.target_y_m', 'control.gaze.target_z_m'], ['joint.pan.position_rad', 'joint.left_eye_pan.position_rad'], joints.map((joint) => `joint.${joint}.position_rad`), joints.map((joint) => `joint.${joint}.velocity_rad_s`)]
    : [['plant.base.height_m', 'base.height_m'], ['joint.l_knee.position_rad', 'joint.r_knee.position_rad'], ['base.pitch_rad', 'base.roll_rad']];
  return wanted.map((names) => names.filter((name) => session.signals.has(name))).filter((names) => names.length > 0);
}

export function first_theme() {
  const wanted = new URLSearchParams(location.search).get('theme') ?? kept('theme');
  if (wanted === 'dark' || wanted === 'light') return wanted;
  return matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
}

const is_plots = (found) => Array.isArray(found) && found.every((names) => Array.isArray(names) && names.length > 0 && names.every((name) => typeof name === 'string'));

// Plots that somebody made stay, for each robot; else some to begin with. Another tab's come when the page is loaded.
function usePlots(session) {
  const key = `plots.${session.description?.robot.name ?? ''}`;
  const [made, set_made] = useState({});
  const last = useMemo(() => kept(key), [key]);
  const chosen = made[key] ?? (is_plots(last) ? last : null) ?? first_plots(session).slice(0, 2);
  const change = (next) => {
    keep(key, next);
    set_made((all) => ({ ...all, [key]: next }));
  };
  return [chosen, change];
}

// "squat in settle - Kadans": of each behavior that plays, all active states.
function page_title(session) {
  const plays = (session.description?.behaviors ?? []).map((behavior) => [behavior.name, active_paths(session, behavior, session.cursor_s)]);
  const told = [...new Map(plays)].filter(([, paths]) => paths.length > 0).map(([name, paths]) => `${name} in ${paths.join(', ')}`);
  return [...told, 'Kadans'].join(' - ');
}

function Help({ close }) {
  return (
    <dialog open class="help" onClick={close}>
      <h2>Keys</h2>
      <dl>{keys.map(([key, what]) => <div key={key}><dt><kbd>{key}</kbd></dt><dd>{what}</dd></div>)}</dl>
      <p>Drag a signal into the plots. In a plot: click to go there, drag to zoom, double-click for all.</p>
    </dialog>
  );
}

function Tabs({ session, tab, set_tab }) {
  useSession(session, 3);
  const level = session.value('safety.level');
  return (
    <nav class="tabs" role="tablist">
      {tabs.map(([name], i) => (
        <button key={name} role="tab" aria-selected={i === tab} onClick={() => set_tab(i)}>
          {name}{name === 'Safety' && level > 0 && <i class={`alert level${level}`} title={rungs[level]} />}
        </button>
      ))}
    </nav>
  );
}

export function App({ session, frames, drawing, open }) {
  const [theme, set_theme] = useState(first_theme);
  const [tab, set_tab] = useState(() => Number(new URLSearchParams(location.search).get('tab') ?? 0));
  const [help, set_help] = useState(false);
  const [plots, set_plots] = usePlots(session);
  const search_box = useRef();
  const shown = useShown(session);
  useSession(session, 2);
  useEffect(() => {
    document.documentElement.dataset.theme = theme;
    keep('theme', theme);
  }, [theme]);
  useEffect(() => {
    document.title = page_title(session);
  });
  const turn = () => set_theme((now) => (now === 'dark' ? 'light' : 'dark'));
  useEffect(
    () =>
      listen_to_keys({
        session: () => shown.current,
        tab: set_tab,
        find: () => search_box.current?.focus(),
        look: () => globalThis.kadans_stage?.look_from_start(),
        theme: turn,
        help: (open) => set_help((now) => open ?? !now),
      }),
    [],
  );
  const add = (name) => set_plots(plots.length > 0 && !plots.at(-1).includes(name) && plots.at(-1).length < 3 ? [...plots.slice(0, -1), [...plots.at(-1), name]] : [...plots, [name]]);
  const Panel = tabs[tab][1];
  return (
    <div class="page">
      <TopBar {...{ session, theme, turn, open }} help={() => set_help(!help)} />
      <SignalList {...{ session, add, search_box }} />
      <main>
        <RobotPanel {...{ session, theme, drawing, open }} />
        <Plots {...{ session, plots, set_plots, theme, frames }} />
      </main>
      <aside>
        <Tabs {...{ session, tab, set_tab }} />
        <div class="panel" role="tabpanel"><Panel key={tab} session={session} /></div>
      </aside>
      <ScrubBar {...{ session, frames }} />
      {help && <Help close={() => set_help(false)} />}
    </div>
  );
}
