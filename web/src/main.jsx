// Which session is shown: ?record=ADDRESS, a file that is dropped, or the run behind the server that the page came from.
import { render } from 'preact';
import 'uplot/dist/uPlot.min.css';
import './style.css';
import { App } from './app.jsx';
import { open_live } from './data/live_source.js';
import { open_record } from './data/record_source.js';
import { Session } from './data/session.js';
import { Frames } from './frames.js';

// Where the machine draws in software, the shell's first picture keeps the graphics process for as long as all the rest
// takes; so the robot's place is made ready before it, unless that would keep the shell from the eye. ?fine spares nothing.
const shell_waits_ms = 150;
const frames = new Frames();
const wanted = new URLSearchParams(location.search);
const drawing = wanted.has('render') ? null : import('./robot/robot_view.js').then(({ RobotView }) => new RobotView(frames, wanted.has('fine')));
const ready = Promise.race([drawing?.catch(() => {}), new Promise((resolve) => setTimeout(resolve, shell_waits_ms))]);
let session = null;

function show(next) {
  session?.remote?.close();
  session = next;
  Object.assign(globalThis, { kadans: session, kadans_frames: frames }); // for the console, and for tests
  frames.advance = (dt_s) => session.advance(dt_s);
  const open = (source) => show(open_record(source));
  ready.then(() => render(<App {...{ session, frames, drawing, open }} />, document.getElementById('app')));
}

addEventListener('dragover', (event) => event.preventDefault());
addEventListener('drop', (event) => {
  event.preventDefault();
  const file = event.dataTransfer.files[0];
  if (file) show(open_record(file));
});

if (wanted.has('render')) import('./render.js').then(({ render_record }) => render_record(open_record(new URL(wanted.get('record'), location.href).href), wanted));
else if (wanted.has('record')) show(open_record(new URL(wanted.get('record'), location.href).href, wanted.get('title')));
else if (wanted.has('empty')) show(new Session('none', false));
else show(open_live(globalThis.kadans_run)); // of early.js
