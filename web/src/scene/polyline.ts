// A line as thick as wanted, in pixels or in units of the model, whose points change with every frame.
import * as three from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";

export interface LineStyle {
  color: string;
  width: number;
  /** The width is in units of the model, not in pixels. */
  world?: boolean;
  opacity?: number;
  flat: boolean;
  order: number;
}

export class Polyline {
  readonly object: LineSegments2;
  readonly material: LineMaterial;
  private readonly geometry = new LineSegmentsGeometry();
  private buffer!: three.InstancedInterleavedBuffer;
  private capacity = 0;

  constructor(style: LineStyle) {
    const opacity = style.opacity ?? 1;
    this.material = new LineMaterial({
      color: new three.Color(style.color),
      linewidth: style.width,
      worldUnits: style.world ?? false,
      transparent: style.flat || opacity < 1,
      opacity,
      depthTest: !style.flat,
      depthWrite: !style.flat && opacity === 1,
    });
    this.object = new LineSegments2(this.geometry, this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = style.order;
    this.reserve(32);
  }

  private reserve(segments: number): void {
    if (segments <= this.capacity) return;
    this.geometry.dispose();
    this.capacity = Math.max(segments, 2 * this.capacity);
    this.buffer = new three.InstancedInterleavedBuffer(new Float32Array(6 * this.capacity), 6, 1);
    this.buffer.setUsage(three.DynamicDrawUsage);
    this.geometry.setAttribute("instanceStart", new three.InterleavedBufferAttribute(this.buffer, 3, 0));
    this.geometry.setAttribute("instanceEnd", new three.InterleavedBufferAttribute(this.buffer, 3, 3));
    this.geometry.instanceCount = 0;
  }

  /** The line through `count` points from the `first`, each three numbers. */
  set(points: ArrayLike<number>, count: number, first = 0): void {
    const segments = Math.max(0, count - 1);
    this.reserve(segments);
    const to = this.buffer.array as Float32Array;
    for (let i = 0; i < segments; ++i) {
      const from = 3 * (first + i);
      for (let k = 0; k < 6; ++k) to[6 * i + k] = points[from + k]!;
    }
    this.geometry.instanceCount = segments;
    this.object.visible = segments > 0;
    this.buffer.clearUpdateRanges();
    this.buffer.addUpdateRange(0, 6 * segments);
    this.buffer.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }
}
