// How finely the scene is drawn. Where pictures take long, pixels are given up while things move; a picture that stands is
// drawn with all of them. Pure.

/** A browser that shows 60 pictures a second has one every 16.7 ms; from here on it misses every second one. */
const long = 25;
/** Pictures that are looked at before anything is changed. */
const enough = 12;
const coarser = 0.8;

export class Pace {
  /** Pixels of the picture for one of the screen, along one side. */
  share = 1;
  private count = 0;
  private sum = 0;

  /** `least`: the smallest share that still looks like something. */
  constructor(readonly least: number) {}

  /** The browser was ready for the next picture after so many milliseconds. True when the share has changed. */
  took(milliseconds: number): boolean {
    if (!(milliseconds > 0 && milliseconds < 1000)) return false;
    this.sum += milliseconds;
    if (++this.count < enough) return false;
    const mean = this.sum / this.count;
    this.count = this.sum = 0;
    if (mean <= long || this.share <= this.least) return false;
    this.share = Math.max(this.least, coarser * this.share);
    return true;
  }
}
