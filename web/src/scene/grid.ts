// The plane behind a two-dimensional scene: grid, numbers at its edges, floors.
import { formatNumber } from "../format";
import { gridStep } from "./fit";

/** The part of the plane that the picture shows, in units of the model. */
export interface Window2d {
  centre: [number, number];
  height: number;
  width: number;
}

export interface GridPaint {
  line: string;
  axis: string;
  text: string;
  floor: string;
  floorLine: string;
}

export function drawGrid(canvas: HTMLCanvasElement, view: Window2d, floors: readonly { height: number; color: string | null }[], paint: GridPaint): void {
  const context = canvas.getContext("2d");
  if (!context) return;
  const ratio = Math.min(2, window.devicePixelRatio || 1);
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  const scale = height / view.height;
  const toX = (x: number): number => width / 2 + (x - view.centre[0]) * scale;
  const toY = (y: number): number => height / 2 - (y - view.centre[1]) * scale;
  if (!Number.isFinite(scale) || scale <= 0) return;

  for (const floor of floors) {
    const y = toY(floor.height);
    if (y > height) continue;
    context.fillStyle = paint.floor;
    context.fillRect(0, Math.max(0, y), width, height);
  }
  const step = gridStep(view.height, height / 70);
  const font = parseFloat(getComputedStyle(canvas).fontSize) || 12;
  context.font = `${font}px ${getComputedStyle(canvas).fontFamily}`;
  context.textBaseline = "middle";
  context.lineWidth = 1;
  const lineAt = (x0: number, y0: number, x1: number, y1: number, zero: boolean): void => {
    context.strokeStyle = zero ? paint.axis : paint.line;
    context.beginPath();
    context.moveTo(x0, y0);
    context.lineTo(x1, y1);
    context.stroke();
  };
  const first = (from: number): number => Math.ceil(from / step);
  const left = view.centre[0] - view.width / 2;
  const bottom = view.centre[1] - view.height / 2;
  for (let i = first(left); i * step <= left + view.width; ++i) lineAt(Math.round(toX(i * step)) + 0.5, 0, Math.round(toX(i * step)) + 0.5, height, i === 0);
  for (let i = first(bottom); i * step <= bottom + view.height; ++i) lineAt(0, Math.round(toY(i * step)) + 0.5, width, Math.round(toY(i * step)) + 0.5, i === 0);
  for (const floor of floors) {
    const y = Math.round(toY(floor.height));
    if (y < -2 || y > height + 2) continue;
    context.strokeStyle = floor.color ?? paint.floorLine;
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(0, y);
    context.lineTo(width, y);
    context.stroke();
  }
  context.fillStyle = paint.text;
  context.textAlign = "center";
  const room = font * 4.5;
  let before = -Infinity;
  for (let i = first(left); i * step <= left + view.width; ++i) {
    const x = toX(i * step);
    if (x < 3 * font || x > width - 2 * font || x - before < room) continue;
    context.fillText(formatNumber(i * step, 6), x, height - font);
    before = x;
  }
  context.textAlign = "left";
  for (let i = first(bottom); i * step <= bottom + view.height; ++i) {
    const y = toY(i * step);
    if (y > height - 2.2 * font || y < font) continue;
    context.fillText(formatNumber(i * step, 6), 0.6 * font, y);
  }
}
