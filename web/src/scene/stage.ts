// Camera, lights and the ways to move them. Draws only when something has changed.
import * as three from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { centre, centreHeight, distanceFor, heightFor, type Bounds } from "./fit";
import { Surface } from "./surface";

const fov = 35;

export class Stage {
  readonly scene = new three.Scene();
  readonly surface: Surface;
  camera: three.OrthographicCamera | three.PerspectiveCamera;
  /** Where the floor of a scene in the plane is, if it has one. */
  floor: number | null = null;
  /** The picture follows the scene until a person moves it. */
  automatic = true;
  /** Pictures drawn so far. */
  drawn = 0;
  private controls: OrbitControls | null = null;
  private viewHeight = 2;
  private queued = 0;
  private flat = true;

  constructor(
    private readonly frame: HTMLElement,
    private readonly beforeDrawing: () => void,
    private readonly moved: () => void,
  ) {
    this.surface = new Surface(() => ({ width: this.width, height: this.height }), () => this.invalidate());
    this.camera = new three.OrthographicCamera();
    const sun = new three.DirectionalLight(0xffffff, 2.2);
    sun.position.set(-0.6, -0.7, 1.2);
    this.scene.add(new three.HemisphereLight(0xffffff, 0x8899aa, 1.5), sun);
    new ResizeObserver(() => this.resize()).observe(frame);
  }

  get width(): number {
    return this.frame.clientWidth || 1;
  }
  get height(): number {
    return this.frame.clientHeight || 1;
  }

  /** A fresh camera, from the front in the plane, from the side and a little above in space; `many` bodies are drawn more cheaply. */
  begin(dimension: 2 | 3, many: boolean): void {
    this.flat = dimension === 2;
    this.surface.begin(!many);
    this.controls?.dispose();
    if (this.flat) {
      this.camera = new three.OrthographicCamera(-1, 1, 1, -1, -1e4, 1e4);
      this.camera.position.set(0, 0, 100);
    } else {
      this.camera = new three.PerspectiveCamera(fov, 1, 0.01, 1e4);
      this.camera.up.set(0, 0, 1);
      this.camera.position.set(4, -8, 3.4);
    }
    const controls = new OrbitControls(this.camera, this.surface.element);
    controls.enableDamping = false;
    controls.enableRotate = !this.flat;
    controls.screenSpacePanning = true;
    controls.zoomToCursor = true;
    if (this.flat) {
      controls.mouseButtons = { LEFT: three.MOUSE.PAN, MIDDLE: three.MOUSE.DOLLY, RIGHT: three.MOUSE.PAN };
      controls.touches = { ONE: three.TOUCH.PAN, TWO: three.TOUCH.DOLLY_PAN };
    }
    controls.addEventListener("start", () => (this.automatic = false));
    controls.addEventListener("change", () => this.invalidate());
    controls.addEventListener("end", () => this.moved());
    this.controls = controls;
    this.automatic = true;
    this.resize();
  }

  set movable(movable: boolean) {
    if (this.controls) this.controls.enabled = movable;
  }

  invalidate(): void {
    if (this.queued) return;
    this.queued = requestAnimationFrame(() => {
      this.queued = 0;
      this.draw();
    });
  }

  /** Draws at once. What the canvas holds can be copied until the browser has shown it. */
  draw(): void {
    this.beforeDrawing();
    this.surface.draw(this.scene, this.camera);
    ++this.drawn;
  }

  private resize(): void {
    this.surface.resize();
    this.setFrustum();
    this.invalidate();
  }

  private setFrustum(): void {
    const aspect = this.width / this.height;
    if (this.camera instanceof three.OrthographicCamera) {
      this.camera.top = this.viewHeight / 2;
      this.camera.bottom = -this.viewHeight / 2;
      this.camera.left = (-this.viewHeight / 2) * aspect;
      this.camera.right = (this.viewHeight / 2) * aspect;
    } else {
      this.camera.aspect = aspect;
    }
    this.camera.updateProjectionMatrix();
  }

  /** Moves the picture towards what it should hold, by `part` of the way, with `follow` its centre at once. True while there is a way to go. */
  approach(bounds: Bounds, part: number, follow = false): boolean {
    if (!this.controls) return false;
    const aspect = this.width / this.height;
    const goal = new three.Vector3(centre(bounds, 0), centre(bounds, 1), this.flat ? 0 : centre(bounds, 2));
    const target = this.controls.target;
    if (this.camera instanceof three.OrthographicCamera) {
      const height = heightFor(bounds, aspect);
      const seen = this.viewHeight / this.camera.zoom;
      // What grows must not leave the picture; what shrinks may take its time.
      if (height > seen) part = 1;
      this.viewHeight = seen * (height / seen) ** part;
      goal.y = centreHeight(bounds, this.viewHeight, this.floor);
      this.camera.zoom = 1;
      target.lerp(goal, follow ? 1 : part);
      this.camera.position.set(target.x, target.y, 100);
      this.setFrustum();
      return Math.abs(Math.log(height / this.viewHeight)) > 0.002 || target.distanceTo(goal) > 0.001 * height;
    }
    const way = this.camera.position.clone().sub(target);
    const back = way.clone().normalize();
    const right = this.camera.up.clone().cross(back).normalize();
    const above = back.clone().cross(right);
    const wanted = distanceFor(bounds, back.toArray(), right.toArray(), above.toArray(), Math.tan(((fov / 2) * Math.PI) / 180), aspect);
    if (wanted > way.length()) part = 1;
    const distance = way.length() * (wanted / way.length()) ** part;
    target.lerp(goal, follow ? 1 : part);
    this.camera.position.copy(target).addScaledVector(way.normalize(), distance);
    this.camera.near = distance / 200;
    this.camera.far = distance * 50;
    this.camera.lookAt(target);
    this.setFrustum();
    return Math.abs(Math.log(wanted / distance)) > 0.002;
  }

  /** The height of what is seen at the target, in units of the model. */
  get seenHeight(): number {
    if (this.camera instanceof three.OrthographicCamera) return this.viewHeight / this.camera.zoom;
    return 2 * Math.tan(((fov / 2) * Math.PI) / 180) * this.camera.position.distanceTo(this.controls?.target ?? new three.Vector3());
  }

  /** How long a pixel is at a point. */
  pixelAt(point: readonly [number, number, number]): number {
    if (this.flat) return this.seenHeight / this.height;
    return (2 * Math.tan(((fov / 2) * Math.PI) / 180) * this.camera.position.distanceTo(new three.Vector3(...point))) / this.height;
  }

  get target(): three.Vector3 {
    return this.controls?.target ?? new three.Vector3();
  }

  /** The camera moves along until `point` is in the middle. */
  lookAt([x, y, z]: readonly [number, number, number]): void {
    if (!Number.isFinite(x + y + z)) return;
    this.automatic = false;
    const way = new three.Vector3(x, y, z).sub(this.target);
    this.target.add(way);
    this.camera.position.add(way);
  }

  zoom(factor: number): void {
    this.automatic = false;
    if (this.camera instanceof three.OrthographicCamera) {
      this.camera.zoom *= factor;
      this.camera.updateProjectionMatrix();
    } else {
      this.camera.position.sub(this.target).divideScalar(factor).add(this.target);
    }
    this.controls?.update();
    this.moved();
    this.invalidate();
  }

  /** Shifts by parts of the picture; in space it turns around the target instead. */
  turnOrPan(right: number, up: number): void {
    this.automatic = false;
    if (this.flat) {
      const shift = new three.Vector3(right * this.seenHeight, up * this.seenHeight, 0);
      this.target.add(shift);
      this.camera.position.add(shift);
    } else {
      const way = this.camera.position.clone().sub(this.target);
      const round = new three.Spherical().setFromVector3(new three.Vector3(way.x, way.z, -way.y));
      round.theta += right;
      round.phi = Math.min(Math.PI - 0.05, Math.max(0.05, round.phi - up));
      const turned = new three.Vector3().setFromSpherical(round);
      this.camera.position.copy(this.target).add(new three.Vector3(turned.x, -turned.z, turned.y));
    }
    this.controls?.update();
    this.moved();
    this.invalidate();
  }

  /** The view as numbers for the address: centre and height in the plane, eye and target in space. */
  get view(): number[] {
    const { x, y, z } = this.target;
    if (this.flat) return [x, y, this.seenHeight];
    return [...this.camera.position.toArray(), x, y, z];
  }
  set view(numbers: number[]) {
    if (!numbers.every(Number.isFinite) || numbers.length !== (this.flat ? 3 : 6)) return;
    this.automatic = false;
    if (this.camera instanceof three.OrthographicCamera) {
      this.viewHeight = Math.max(1e-12, numbers[2]!);
      this.camera.zoom = 1;
      this.target.set(numbers[0]!, numbers[1]!, 0);
      this.camera.position.set(numbers[0]!, numbers[1]!, 100);
    } else {
      this.camera.position.fromArray(numbers);
      this.target.fromArray(numbers, 3);
      const distance = this.camera.position.distanceTo(this.target);
      this.camera.near = distance / 200;
      this.camera.far = distance * 50;
    }
    this.setFrustum();
    this.controls?.update();
    this.invalidate();
  }

  project(point: readonly [number, number, number]): { x: number; y: number; visible: boolean } {
    const seen = new three.Vector3(...point).project(this.camera);
    return { x: ((seen.x + 1) / 2) * this.width, y: ((1 - seen.y) / 2) * this.height, visible: seen.z < 1 && Math.abs(seen.x) < 1.3 && Math.abs(seen.y) < 1.3 };
  }

  /** The ray under a place of the canvas. */
  ray(x: number, y: number): three.Ray {
    const caster = new three.Raycaster();
    caster.setFromCamera(new three.Vector2((2 * x) / this.width - 1, 1 - (2 * y) / this.height), this.camera);
    return caster.ray;
  }

  /** Where the ray under a place of the canvas meets the plane through `through` that faces the eye. */
  onPlane(x: number, y: number, through: three.Vector3): three.Vector3 | null {
    const normal = this.camera.getWorldDirection(new three.Vector3());
    return this.ray(x, y).intersectPlane(new three.Plane().setFromNormalAndCoplanarPoint(normal, through), new three.Vector3());
  }

  get isFlat(): boolean {
    return this.flat;
  }
}
