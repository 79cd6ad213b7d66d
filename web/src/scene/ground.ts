// Meshes and chains of a world, which never move.
import * as three from "three";
import type { StaticMesh } from "../protocol";

/** The corners of the facets as triangles in space, one after the other. */
export function trianglesOf({ corners, facets }: StaticMesh): Float32Array {
  const points = new Float32Array(9 * facets.length);
  facets.forEach((facet, index) => facet.forEach((corner, k) => points.set(corners[corner]!, 9 * index + 3 * k)));
  return points;
}

/** The segments of a chain as lines that go on as long as a segment begins where the last one ended: x, y, 0, ... */
export function chainLines({ corners, facets }: StaticMesh): number[][] {
  const lines: number[][] = [];
  let last = -1;
  for (const [from, to] of facets as [number, number][]) {
    if (from !== last) lines.push([...corners[from]!, 0]);
    lines.at(-1)!.push(...corners[to]!, 0);
    last = to;
  }
  return lines;
}

/** A band of this width behind the segments of a chain, as triangles: what is there is not free. */
export function bandOf({ corners, facets }: StaticMesh, width: number): Float32Array {
  const points = new Float32Array(18 * facets.length);
  facets.forEach(([from, to], index) => {
    const [ax, ay] = corners[from!] as [number, number];
    const [bx, by] = corners[to!] as [number, number];
    const length = Math.hypot(bx - ax, by - ay);
    const [x, y] = [(-(by - ay) / length) * width, ((bx - ax) / length) * width];
    points.set([ax, ay, 0, bx, by, 0, bx + x, by + y, 0, ax, ay, 0, bx + x, by + y, 0, ax + x, ay + y, 0], 18 * index);
  });
  return points;
}

/** As wide as looks well beside so long a chain. */
export function bandWidth({ corners }: StaticMesh): number {
  const extent = (axis: number): number => {
    const places = corners.map((corner) => corner[axis]!);
    return places.reduce((most, place) => Math.max(most, place), -Infinity) - places.reduce((least, place) => Math.min(least, place), Infinity);
  };
  return Math.max(extent(0), extent(1)) / 50;
}

const faceColor = "#b4bec8";
/** Of more triangles edges would hide the faces. */
const fewTriangles = 5000;

/** Lit faces, seen from both sides where both are free, and their edges. */
export function surfaceOf(mesh: StaticMesh, color: string): three.Object3D & { parts: { geometry: three.BufferGeometry; material: three.Material }[] } {
  const geometry = new three.BufferGeometry().setAttribute("position", new three.Float32BufferAttribute(trianglesOf(mesh), 3));
  geometry.computeVertexNormals();
  const faces = new three.Mesh(geometry, new three.MeshLambertMaterial({ color: faceColor, side: three.DoubleSide, flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
  const parts: { geometry: three.BufferGeometry; material: three.Material }[] = [faces];
  const group = new three.Group();
  group.add(faces);
  if (mesh.facets.length <= fewTriangles) {
    const edges = new three.LineSegments(new three.EdgesGeometry(geometry, 1), new three.LineBasicMaterial({ color, transparent: true, opacity: 0.5 }));
    parts.push(edges);
    group.add(edges);
  }
  return Object.assign(group, { parts });
}
