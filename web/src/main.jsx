// Which session is shown: ?record=ADDRESS, a file that is dropped, or the run behind the server that the page came from.
import { render } from 'preact';
import 'uplot/dist/uPlot.min.css';
import './style.css';
import { App } from './app.jsx';
import { open_live } from './data/live_source.js';
import { open_record } from './data/record_source.js';
import { Session } from './data/session.js';
import { Frames } from './frames.js';

const frames = new Frames();
let session = null;

function show(next) {
  session?.remote?.close();
  session = next;
  globalThis.kadans = session; // for the console, and for tests
  frames.advance = (dt_s) => session.advance(dt_s);
  render(<App session={session} frames={frames} open={(source) => show(open_record(source))} />, document.getElementById('app'));
}

addEventListener('dragover', (event) => event.preventDefault());
addEventListener('drop', (event) => {
  event.preventDefault();
  const file = event.dataTransfer.files[0];
  if (file) show(open_record(file));
});

const wanted = new URLSearchParams(location.search);
if (wanted.has('render')) import('./render.js').then(({ render_record }) => render_record(open_record(new URL(wanted.get('record'), location.href).href), wanted));
else if (wanted.has('record')) show(open_record(new URL(wanted.get('record'), location.href).href, wanted.get('title')));
else if (wanted.has('empty')) show(new Session('none', false));
else {
  const address = new URL(wanted.get('live') ?? '.', location.href);
  address.protocol = address.protocol.replace('http', 'ws');
  address.search = '';
  show(open_live(address.href, wanted.get('token') ?? ''));
}
