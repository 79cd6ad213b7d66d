// Many spheres in one draw call: each a triangle around a disc that faces the eye, shaded as a sphere and as deep as one.
// Three corners a sphere instead of the hundreds of a mesh. They are vertices of one mesh, not instances: rendering in
// software pays some 20 microseconds for each instance, whatever is in it, and a graphics card draws either as fast. Not
// points either: those vanish as soon as their centre leaves the picture.
import * as three from "three";

const vertex = /* glsl */ `
  in float radius;
  in vec4 tint;
  in vec4 turn;
  uniform float pixel;       // the size of a pixel: in the plane, or at distance 1
  uniform float least;       // the smallest radius, in pixels
  out vec2 corner;
  flat out vec3 color;
  flat out float fine;       // a pixel in radii of this sphere
  flat out vec2 depth;       // the centre's distance along the view, and the radius
  #ifdef MARKED
    flat out mat3 own;       // takes a normal of the picture into the sphere's own axes
  #endif
  void main() {
    if (radius == 0.0) {  // no sphere, but a body of another shape
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      return;
    }
    vec4 centre = modelViewMatrix * vec4(position, 1.0);
    float scale = projectionMatrix[2][3] == 0.0 ? pixel : -centre.z * pixel;
    float size = max(radius, least * scale);
    fine = scale / size;
    depth = vec2(centre.z, size);
    color = tint.rgb;
    // The triangle around the circle of radius 1 and the pixel around it.
    int at = gl_VertexID % 3;
    corner = (1.0 + fine) * (at == 0 ? vec2(0.0, 2.0) : vec2(at == 1 ? -1.7320508 : 1.7320508, -1.0));
    #ifdef MARKED
    vec4 q = turn;
    vec3 x = vec3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    vec3 y = vec3(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    own = transpose(mat3(viewMatrix) * mat3(x, y, cross(x, y)));
    #endif
    centre.xy += corner * size;
    gl_Position = projectionMatrix * centre;
  }`;

/** PLANE: discs in the plane. MARKED: octants (quarters) of two shades show how it turns. An edge is mixed with what was drawn before
it: smooth without several samples a pixel, which cost three times as much as all else where no graphics card draws. */
const fragment = /* glsl */ `
  uniform float opacity;
  in vec2 corner;
  flat in vec3 color;
  flat in float fine;
  flat in vec2 depth;
  #ifdef MARKED
    flat in mat3 own;
  #endif
  out vec4 shown;
  void main() {
    float square = dot(corner, corner);
    float from_centre = sqrt(square);
    float cover = 1.0 - smoothstep(1.0 - fine, 1.0 + 0.5 * fine, from_centre);
    if (cover < 0.25) discard;
    vec3 normal = vec3(corner, sqrt(max(0.0, 1.0 - square)));
    float light = max(0.0, dot(normal, vec3(-0.4014, 0.6244, 0.6690)));
    float gloss = light * light;
    gloss *= gloss;
    gloss *= gloss;
    gloss *= gloss;
    gloss *= gloss;
    #ifdef PLANE
      float shade = 0.80 + 0.24 * light;
      gloss *= 0.10;
    #else
      // Light from above, what the ground gives back, and less of either at the rim.
      float shade = (0.40 + 0.10 * normal.y + 0.62 * light) * (0.82 + 0.18 * normal.z);
      gloss *= 0.20;
    #endif
    #ifdef MARKED
      vec3 side = own * normal;
      #ifdef PLANE
        float stripe = side.x * side.y;
      #else
        float stripe = 1.7 * side.x * side.y * side.z;
      #endif
      shade *= 0.87 - 0.13 * clamp(stripe / (0.8 * fine + 0.01), -1.0, 1.0);
    #endif
    vec3 painted = color * shade + gloss;
    #ifdef PLANE
      painted *= mix(1.0, 0.72, smoothstep(1.0 - 3.0 * fine, 1.0 - fine, sqrt(square)));
    #else
      // The surface of the sphere, not its disc, is what a floor or another sphere cuts.
      float z = depth.x + normal.z * depth.y;
      float far = projectionMatrix[2][3] == 0.0 ? projectionMatrix[2][2] * z + projectionMatrix[3][2] : (projectionMatrix[2][2] * z + projectionMatrix[3][2]) / -z;
      gl_FragDepth = 0.5 * far + 0.5;
    #endif
    shown = vec4(min(painted, 1.0), cover * opacity);
  }`;

/** Of fewer pixels in radius nobody sees how a sphere turns, and rendering in software pays for every number that is handed on. */
const marked = 2.5;

export interface SpheresLook {
  /** Discs in the plane, one over the other as they are numbered. */
  flat: boolean;
  opacity?: number;
  /** The smallest radius, in pixels. */
  least?: number;
  order?: number;
}

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
  private turned = false;

  constructor(
    readonly count: number,
    look: SpheresLook,
  ) {
    this.places = new Float32Array(3 * count);
    const attribute = (name: string, values: Float32Array | Uint8Array, size: number, use: three.Usage): three.BufferAttribute => {
      const made = new three.BufferAttribute(values, size, values instanceof Uint8Array);
      made.setUsage(use);
      this.geometry.setAttribute(name, made);
      return made;
    };
    this.corners = attribute("position", new Float32Array(9 * count), 3, three.DynamicDrawUsage);
    this.radii = attribute("radius", new Float32Array(3 * count), 1, three.StaticDrawUsage);
    this.tints = attribute("tint", new Uint8Array(12 * count), 4, three.StaticDrawUsage);
    this.turns = attribute("turn", new Float32Array(12 * count), 4, three.DynamicDrawUsage);
    const opacity = look.opacity ?? 1;
    this.material = new three.ShaderMaterial({
      glslVersion: three.GLSL3,
      vertexShader: vertex,
      fragmentShader: `uniform mat4 projectionMatrix;\n${fragment}`,
      uniforms: { pixel: { value: 1 }, least: { value: look.least ?? 2.5 }, opacity: { value: opacity } },
      defines: look.flat ? { PLANE: 1 } : {},
      transparent: true,
      depthTest: !look.flat,
      depthWrite: !look.flat && opacity === 1,
    });
    this.object = new three.Mesh(this.geometry, this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = look.order ?? 0;
    const size = new three.Vector2();
    this.object.onBeforeRender = (renderer, _scene, camera) => {
      const height = renderer.getDrawingBufferSize(size).y;
      const seen = camera instanceof three.OrthographicCamera ? (camera.top - camera.bottom) / camera.zoom : 2 * Math.tan((((camera as three.PerspectiveCamera).fov / 2) * Math.PI) / 180);
      const pixel = seen / height;
      this.material.uniforms["pixel"]!.value = pixel;
      this.define("MARKED", this.turned && this.largestSeen(pixel, camera) > marked);
    };
  }

  place(index: number, x: number, y: number, z: number, radius: number): void {
    const places = this.places;
    places[3 * index] = x;
    places[3 * index + 1] = y;
    places[3 * index + 2] = z;
    for (let corner = 3 * index; corner < 3 * index + 3; ++corner) {
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
    const to = this.tints.array;
    for (let corner = 3 * index; corner < 3 * index + 3; ++corner) {
      to[4 * corner] = Math.round(255 * r);
      to[4 * corner + 1] = Math.round(255 * g);
      to[4 * corner + 2] = Math.round(255 * b);
    }
    this.tints.needsUpdate = true;
  }

  /** All centres at once, as a frame has them. */
  placeAll(positions: Float32Array, dimension: number): void {
    const { places, count } = this;
    const to = this.corners.array as Float32Array;
    for (let i = 0, at = 0; i < count; ++i) {
      const x = positions[dimension * i]!;
      const y = positions[dimension * i + 1]!;
      const z = dimension === 3 ? positions[3 * i + 2]! : 0;
      places[3 * i] = x;
      places[3 * i + 1] = y;
      places[3 * i + 2] = z;
      for (let corner = 0; corner < 3; ++corner) {
        to[at++] = x;
        to[at++] = y;
        to[at++] = z;
      }
    }
    this.corners.needsUpdate = true;
  }

  /** All orientations at once: an angle each in the plane, a quaternion x y z w each in space; null shows none. */
  turnAll(orientations: Float32Array | null, dimension: number): void {
    this.turned = orientations !== null;
    if (!orientations) return;
    const to = this.turns.array as Float32Array;
    for (let i = 0, at = 0; i < this.count; ++i) {
      const half = dimension === 2 ? orientations[i]! / 2 : 0;
      const x = dimension === 2 ? 0 : orientations[4 * i]!;
      const y = dimension === 2 ? 0 : orientations[4 * i + 1]!;
      const z = dimension === 2 ? Math.sin(half) : orientations[4 * i + 2]!;
      const w = dimension === 2 ? Math.cos(half) : orientations[4 * i + 3]!;
      for (let corner = 0; corner < 3; ++corner) {
        to[at++] = x;
        to[at++] = y;
        to[at++] = z;
        to[at++] = w;
      }
    }
    this.turns.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }

  /** About how large the nearest spheres are, in pixels, by some of them. */
  private largestSeen(pixel: number, camera: three.Camera): number {
    const { places, count } = this;
    const stride = Math.max(1, count >> 6);
    const { x, y, z } = camera.position;
    let largest = 0;
    for (let i = 0; i < count; i += stride) {
      const away = camera instanceof three.OrthographicCamera ? 1 : Math.hypot(places[3 * i]! - x, places[3 * i + 1]! - y, places[3 * i + 2]! - z);
      largest = Math.max(largest, this.radii.getX(3 * i) / (away * pixel));
    }
    return largest;
  }

  private define(name: string, wanted: boolean): void {
    if (name in this.material.defines === wanted) return;
    if (wanted) this.material.defines[name] = 1;
    else delete this.material.defines[name];
    this.material.needsUpdate = true;
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
