// The canvas that the scene is drawn on. Whether a pixel has several samples is fixed when a canvas is made, so another one takes
// its place when that changes; how many pixels there are follows the pace of the machine.
import * as three from "three";
import { make } from "../dom";
import { Pace } from "./pace";

/** After so many milliseconds without a new picture the scene stands. */
const standing = 250;

export class Surface {
  /** What hears the pointer: it stays when the canvas goes. */
  readonly element = make("div", { class: "surface" });
  private renderer: three.WebGLRenderer | null = null;
  private smooth: boolean | null = null;
  private pace = new Pace(1);
  private drawnAt = -Infinity;
  private rest = 0;
  private fine = true;

  constructor(
    private readonly size: () => { width: number; height: number },
    private readonly redraw: () => void,
  ) {}

  /** False where the browser has no WebGL: then there is no picture. */
  get works(): boolean {
    return this.renderer !== null;
  }

  get canvas(): HTMLCanvasElement | null {
    return this.renderer?.domElement ?? null;
  }

  /** `smooth`: with several samples a pixel. A world of many bodies does without, and with fewer pixels where it must. */
  begin(smooth: boolean): void {
    this.pace = new Pace(smooth ? 1 / this.screenRatio : 0.7 / this.screenRatio);
    this.fine = true;
    if (smooth === this.smooth) return this.resize();
    this.smooth = smooth;
    if (this.renderer) {
      this.renderer.dispose();
      this.renderer.forceContextLoss();
    }
    try {
      this.renderer = new three.WebGLRenderer({ antialias: smooth, alpha: true });
    } catch {
      this.renderer = null;
      this.element.replaceChildren();
      return;
    }
    this.renderer.setClearAlpha(0);
    this.renderer.domElement.addEventListener("webglcontextrestored", () => this.redraw());
    this.element.replaceChildren(this.renderer.domElement);
    this.resize();
  }

  resize(): void {
    if (!this.renderer) return;
    const { width, height } = this.size();
    this.renderer.setPixelRatio(this.screenRatio * (this.fine ? 1 : this.pace.share));
    this.renderer.setSize(width, height, true);
  }

  draw(scene: three.Scene, camera: three.Camera): void {
    if (!this.renderer) return;
    const now = performance.now();
    // The first picture after a rest says nothing about the pace.
    const moving = now - this.drawnAt < standing;
    this.drawnAt = now;
    if (moving && this.fine && this.pace.share < 1) {
      this.fine = false;
      this.resize();
    }
    this.renderer.render(scene, camera);
    if (!moving) return;
    requestAnimationFrame(() => {
      if (!this.pace.took(performance.now() - now)) return;
      this.fine = false;
      this.resize();
      this.redraw();
    });
    if (!this.fine) this.rest ||= window.setTimeout(() => this.rested(), standing);
  }

  private rested(): void {
    this.rest = 0;
    const left = this.drawnAt + standing - performance.now();
    if (left > 0) {
      this.rest = window.setTimeout(() => this.rested(), left + 10);
      return;
    }
    this.fine = true;
    this.resize();
    this.redraw();
  }

  private get screenRatio(): number {
    return Math.min(2, window.devicePixelRatio || 1);
  }
}
