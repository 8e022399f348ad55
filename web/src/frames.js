// The one loop over the screen's frames: time goes on, then whoever draws draws.
export class Frames {
  constructor() {
    this.draws = new Set();
    this.advance = () => {};
    let last = performance.now();
    const frame = (now) => {
      requestAnimationFrame(frame);
      const dt_s = Math.min(0.25, (now - last) / 1000);
      last = now;
      this.step(dt_s);
    };
    requestAnimationFrame(frame);
  }

  step(dt_s) {
    this.advance(dt_s);
    for (const draw of this.draws) draw(dt_s);
  }

  add(draw) {
    this.draws.add(draw);
    return () => this.draws.delete(draw);
  }
}
