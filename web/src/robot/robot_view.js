// Draws the session that is looked at on a canvas, whenever something moved. Loaded beside the rest of the page: it
// brings three.js.
import { PushHand } from './push_hand.js';
import { Show } from './show.js';
import { Stage } from './stage.js';

// A machine that draws slower than this gets coarser pictures while something moves, and a sharp one when it rests.
const slow_ms = 26;
const coarse_ratio = 0.6;

export class RobotView {
  // `now()`: {session, shown, theme}.
  constructor(canvas, frames, now) {
    this.canvas = canvas;
    this.now = now;
    this.stage = new Stage(canvas);
    this.show = new Show(this.stage);
    this.drawn = '';
    this.mean_ms = 0;
    globalThis.kadans_stage = this.stage; // for the console, and for tests
    const may_push = () => now().session.remote?.writes && now().session.remote.verbs.has('push');
    const push = (link, impulse_Ns) => now().session.remote.command('push', { text: `${link}=${impulse_Ns.map((part) => part.toFixed(3)).join(',')}` });
    new PushHand(this.stage, () => (may_push() ? this.show.model : null), push);
    this.leave = frames.add(() => this.draw());
  }

  draw() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    const { session, shown, theme } = this.now();
    if (this.theme !== theme) this.stage.set_theme((this.theme = theme));
    this.coarse = session.playing && (this.coarse || this.mean_ms > slow_ms);
    this.stage.resize(clientWidth, clientHeight, this.coarse ? coarse_ratio : undefined);
    const sign = [this.coarse, session.cursor_s, session.version, session.title, clientWidth, clientHeight, ...shown].join();
    if (sign === this.drawn && !this.stage.moved) return; // nothing that moved: let the machine rest
    this.note_pace(session);
    this.drawn = sign;
    this.stage.moved = false;
    this.show.take(session);
    this.show.draw(session.cursor_s, shown);
    this.pictures = (this.pictures ?? 0) + 1;
    globalThis.kadans_drawn = { pictures: this.pictures, robot: Boolean(this.show.model) };
  }

  // How long pictures that follow each other take on this machine.
  note_pace(session) {
    const now = performance.now();
    if (!session.playing) this.mean_ms = 0;
    else if (now - this.last_ms < 500) this.mean_ms += 0.1 * (now - this.last_ms - this.mean_ms);
    this.last_ms = now;
  }

  dispose() {
    this.leave();
    this.stage.dispose();
  }
}
