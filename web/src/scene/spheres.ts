// Many spheres in one draw call: each a square that faces the eye, shaded as a sphere. Two triangles a sphere instead of
// hundreds. The squares are vertices of one mesh, not instances: rendering in software pays some 20 microseconds for each
// instance, whatever is in it, and a graphics card draws either as fast.
import * as three from "three";

const vertex = /* glsl */ `
  attribute float radius;
  attribute vec3 tint;
  attribute vec4 turn;
  attribute vec2 square;
  uniform float pixel;       // the size of a pixel: in the plane, or at distance 1
  uniform float least;       // the smallest radius, in pixels
  varying vec2 corner;
  varying vec3 color;
  varying vec4 turned;
  void main() {
    vec4 centre = modelViewMatrix * vec4(position, 1.0);
    float scale = projectionMatrix[2][3] == 0.0 ? pixel : -centre.z * pixel;
    float size = max(radius, least * scale);
    corner = square * (1.0 + scale / size);
    centre.xy += corner * size;
    color = tint;
    turned = turn;
    gl_Position = projectionMatrix * centre;
  }`;

const fragment = /* glsl */ `
  uniform float opacity;
  uniform bool flat_;
  uniform bool marked;
  varying vec2 corner;
  varying vec3 color;
  varying vec4 turned;
  vec3 turned_back(vec3 v, vec4 q) {
    vec3 u = -q.xyz;
    return v + 2.0 * cross(u, cross(u, v) + q.w * v);
  }
  void main() {
    float from_centre = length(corner);
    float edge = fwidth(from_centre);
    float cover = 1.0 - smoothstep(1.0 - edge, 1.0 + 0.5 * edge, from_centre);
    if (cover <= 0.0) discard;
    vec3 normal = vec3(corner, sqrt(max(0.0, 1.0 - from_centre * from_centre)));
    vec3 shade = color;
    if (marked) {
      vec3 own = turned_back(transpose(mat3(viewMatrix)) * normal, turned);
      float stripe = flat_ ? own.x * own.y : own.x * own.y * own.z;
      float wide = fwidth(stripe) + 1e-4;
      shade *= mix(1.0, 0.72, smoothstep(-wide, wide, stripe));
    }
    float light = max(0.0, dot(normal, normalize(vec3(-0.45, 0.7, 0.75))));
    float gloss = pow(max(0.0, dot(normal, normalize(vec3(-0.28, 0.5, 0.82)))), 40.0);
    shade = flat_ ? shade * (0.80 + 0.24 * light) + 0.10 * gloss : shade * (0.42 + 0.66 * light) + 0.18 * gloss;
    if (flat_) shade *= mix(1.0, 0.72, smoothstep(1.0 - 3.0 * edge, 1.0 - edge, from_centre));
    gl_FragColor = vec4(min(shade, 1.0), cover * opacity);
  }`;

export class Spheres {
  readonly object: three.Mesh;
  /** The centres, three numbers each. */
  readonly places: Float32Array;
  private readonly geometry = new three.BufferGeometry();
  private readonly material: three.ShaderMaterial;
  private readonly corners: three.BufferAttribute;
  private readonly radii: three.BufferAttribute;
  private readonly tints: three.BufferAttribute;
  private readonly turns: three.BufferAttribute;

  constructor(
    readonly count: number,
    options: { flat: boolean; opacity?: number; least?: number; order?: number },
  ) {
    this.places = new Float32Array(3 * count);
    const attribute = (name: string, size: number, use: three.Usage = three.DynamicDrawUsage): three.BufferAttribute => {
      const made = new three.BufferAttribute(new Float32Array(4 * size * count), size);
      made.setUsage(use);
      this.geometry.setAttribute(name, made);
      return made;
    };
    this.corners = attribute("position", 3);
    this.radii = attribute("radius", 1);
    this.tints = attribute("tint", 3, three.StaticDrawUsage);
    this.turns = attribute("turn", 4);
    const square = attribute("square", 2, three.StaticDrawUsage);
    const index = new Uint32Array(6 * count);
    for (let i = 0; i < count; ++i) {
      (square.array as Float32Array).set([-1, -1, 1, -1, 1, 1, -1, 1], 8 * i);
      index.set([4 * i, 4 * i + 1, 4 * i + 2, 4 * i, 4 * i + 2, 4 * i + 3], 6 * i);
    }
    this.geometry.setIndex(new three.BufferAttribute(index, 1));
    const opacity = options.opacity ?? 1;
    const blended = options.flat || opacity < 1;
    this.material = new three.ShaderMaterial({
      vertexShader: vertex,
      fragmentShader: fragment,
      uniforms: { pixel: { value: 1 }, least: { value: options.least ?? 2.5 }, opacity: { value: opacity }, flat_: { value: options.flat }, marked: { value: false } },
      transparent: blended,
      alphaToCoverage: !blended,
      depthTest: !options.flat,
      depthWrite: !options.flat && opacity === 1,
    });
    this.object = new three.Mesh(this.geometry, this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = options.order ?? 0;
    this.object.onBeforeRender = (renderer, _scene, camera) => {
      const height = renderer.getDrawingBufferSize(new three.Vector2()).y;
      const seen = camera instanceof three.OrthographicCamera ? (camera.top - camera.bottom) / camera.zoom : 2 * Math.tan((((camera as three.PerspectiveCamera).fov / 2) * Math.PI) / 180);
      this.material.uniforms["pixel"]!.value = seen / height;
    };
  }

  place(index: number, x: number, y: number, z: number, radius: number): void {
    this.places.set([x, y, z], 3 * index);
    for (let corner = 4 * index; corner < 4 * index + 4; ++corner) {
      this.corners.setXYZ(corner, x, y, z);
      this.radii.setX(corner, radius);
    }
  }

  /** After the last `place`. */
  placed(): void {
    this.corners.needsUpdate = true;
    this.radii.needsUpdate = true;
  }

  tint(index: number, [r, g, b]: readonly [number, number, number]): void {
    for (let corner = 4 * index; corner < 4 * index + 4; ++corner) this.tints.setXYZ(corner, r, g, b);
    this.tints.needsUpdate = true;
  }

  /** All centres at once, as a frame has them. */
  placeAll(positions: Float32Array, dimension: number): void {
    const to = this.corners.array as Float32Array;
    for (let i = 0, at = 0; i < this.count; ++i) {
      const x = positions[dimension * i]!;
      const y = positions[dimension * i + 1]!;
      const z = dimension === 3 ? positions[3 * i + 2]! : 0;
      this.places[3 * i] = x;
      this.places[3 * i + 1] = y;
      this.places[3 * i + 2] = z;
      for (let corner = 0; corner < 4; ++corner) {
        to[at++] = x;
        to[at++] = y;
        to[at++] = z;
      }
    }
    this.corners.needsUpdate = true;
  }

  turnAll(orientations: Float32Array, dimension: number): void {
    for (let i = 0; i < this.count; ++i) {
      const half = dimension === 2 ? orientations[i]! / 2 : 0;
      const x = dimension === 2 ? 0 : orientations[4 * i]!;
      const y = dimension === 2 ? 0 : orientations[4 * i + 1]!;
      const z = dimension === 2 ? Math.sin(half) : orientations[4 * i + 2]!;
      const w = dimension === 2 ? Math.cos(half) : orientations[4 * i + 3]!;
      for (let corner = 4 * i; corner < 4 * i + 4; ++corner) this.turns.setXYZW(corner, x, y, z, w);
    }
    this.material.uniforms["marked"]!.value = true;
    this.turns.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }
}

/** The nearest sphere that a ray meets, each enlarged to at least `least(distance)`: its index, or -1. */
export function pickSphere(
  places: ArrayLike<number>,
  radius: (index: number) => number,
  origin: readonly number[],
  direction: readonly number[],
  least: (distance: number) => number,
): number {
  let best = -1;
  let bestScore = Infinity;
  for (let i = 0; 3 * i < places.length; ++i) {
    const x = places[3 * i]! - origin[0]!;
    const y = places[3 * i + 1]! - origin[1]!;
    const z = places[3 * i + 2]! - origin[2]!;
    const along = x * direction[0]! + y * direction[1]! + z * direction[2]!;
    if (along < 0) continue;
    const miss = Math.sqrt(Math.max(0, x * x + y * y + z * z - along * along));
    const real = radius(i);
    if (miss > Math.max(real, least(along))) continue;
    // A sphere that is hit goes before one that is only near; among those hit the front one.
    const score = miss <= real ? along : 1e9 + miss;
    if (score < bestScore) {
      bestScore = score;
      best = i;
    }
  }
  return best;
}
