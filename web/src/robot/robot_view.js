// Draws the session that is looked at on a canvas, whenever something moved. Loaded beside the rest of the page: it
// brings three.js.
import { PushHand } from './push_hand.js';
import { Show } from './show.js';
import { make_stage } from './stage.js';

// A machine that draws slower than this gets coarser pictures while something moves, and a sharp one when it rests.
const slow_ms = 26;
const coarse_ratio = 0.6;
const rest_ms = 500;

export class RobotView {
  constructor(frames, fine) {
    this.now = null; // told later: () => {session, shown, theme}
    this.stage = make_stage(fine);
    this.canvas = this.stage.renderer.domElement;
    this.canvas.id = 'robot';
    this.canvas.style.visibility = 'hidden'; // it would be black until the first picture
    this.show = new Show(this.stage);
    this.drawn = '';
    this.coarse = false;
    this.mean_ms = this.moved_ms = 0;
    globalThis.kadans_stage = this.stage; // for the console, and for tests
    const may_push = () => this.now().session.remote?.writes && this.now().session.remote.verbs.has('push');
    const push = (link, impulse_Ns) => this.now().session.remote?.command('push', { text: `${link}=${impulse_Ns.map((part) => part.toFixed(3)).join(',')}` });
    new PushHand(this.stage, () => (may_push() ? this.show.model : null), push);
    frames.add(() => this.now && this.draw());
  }

  draw() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    const { session, shown, theme } = this.now();
    if (!this.is_ready(session)) return;
    if (this.theme !== theme) this.stage.set_theme((this.theme = theme));
    const sign = [session.cursor_s, session.version, session.title, clientWidth, clientHeight, ...shown].join();
    const [now_ms, was_coarse] = [performance.now(), this.coarse];
    const still = sign === this.drawn && !this.stage.moved;
    if (!still) this.moved_ms = now_ms;
    this.coarse = now_ms - this.moved_ms < rest_ms && session.playing && (was_coarse || this.mean_ms > slow_ms);
    if (still && this.coarse === was_coarse) return; // let the machine rest
    this.stage.resize(clientWidth, clientHeight, this.coarse ? coarse_ratio : undefined);
    this.note_pace(session);
    this.drawn = sign;
    this.stage.moved = false;
    this.show.take(session);
    this.show.draw(session.cursor_s, shown);
    this.pictures = (this.pictures ?? 0) + 1;
    this.canvas.style.visibility = '';
    globalThis.kadans_drawn = { pictures: this.pictures, robot: Boolean(this.show.model), posed: Boolean(this.show.framed) };
  }

  // An empty place would only keep a machine busy that draws in software, and a robot that nothing is known of yet would
  // stand in a posture that is not its own.
  is_ready(session) {
    if (this.show.model) return true;
    return Boolean(session.urdf) && (session.end_s > 0 || (!session.live && session.loading === 0));
  }

  // How long pictures that follow each other take on this machine.
  note_pace(session) {
    const now = performance.now();
    if (!session.playing) this.mean_ms = 0;
    else if (now - this.last_ms < 500) this.mean_ms += 0.1 * (now - this.last_ms - this.mean_ms);
    this.last_ms = now;
  }
}
