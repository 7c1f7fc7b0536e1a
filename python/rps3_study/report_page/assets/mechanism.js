// The mechanism of one run in its own three.js scene. Base frame: z upwards, lengths in m.

import { THREE } from "three";
import { forceColour } from "rps3/limbs";

const AZIMUTHS = [0, 120, 240].map((degrees) => (degrees * Math.PI) / 180);
const UP = new THREE.Vector3(0, 1, 0); // axis of three.js' cylinders
const DEGENERATE = "#b5179e";
const REACH = 0.16; // longest arrow for a unit twist, m

const polar = (radius, azimuth, z = 0) => new THREE.Vector3(radius * Math.cos(azimuth), radius * Math.sin(azimuth), z);
const material = (color, more = {}) => new THREE.MeshStandardMaterial({ color, roughness: 0.55, metalness: 0.15, ...more });
const tube = (radius, length, paint) => new THREE.Mesh(new THREE.CylinderGeometry(radius, radius, length, 24), paint);

/** Puts a unit cylinder between two points. */
function stretch(mesh, from, to) {
  const line = to.clone().sub(from);
  mesh.position.copy(from).addScaledVector(line, 0.5);
  mesh.scale.set(1, line.length(), 1);
  mesh.quaternion.setFromUnitVectors(UP, line.normalize());
}

/** A short text that faces the camera. */
function sign(text) {
  const board = Object.assign(document.createElement("canvas"), { width: 64, height: 64 });
  const pen = board.getContext("2d");
  Object.assign(pen, { font: "bold 48px sans-serif", textAlign: "center", textBaseline: "middle", fillStyle: "#1c2733" });
  pen.fillText(text, 32, 34);
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(board), depthTest: false }));
  sprite.scale.setScalar(0.06);
  return sprite;
}

export class Mechanism {
  constructor(geometry, singularRegion) {
    this.geometry = geometry;
    this.singularRegion = singularRegion;
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color("#f6f7f9");
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#8b929b", 2.2));
    const sun = new THREE.DirectionalLight("#ffffff", 2.2);
    sun.position.set(0.5, -0.8, 1.5);
    this.scene.add(sun);
    this.addBase();
    this.addPlatform();
    this.addLimbs();
    this.addDegenerate();
  }

  addBase() {
    const { baseRadius } = this.geometry;
    const plate = new THREE.Mesh(new THREE.CylinderGeometry(1.12 * baseRadius, 1.12 * baseRadius, 0.012, 96), material("#dfe3e8", { transparent: true, opacity: 0.45, depthWrite: false }));
    plate.rotation.x = Math.PI / 2;
    plate.position.z = -0.03;
    this.scene.add(plate);
    const ring = new THREE.Mesh(new THREE.TorusGeometry(baseRadius, 0.0025, 12, 128), material("#aab2bc"));
    ring.position.z = -0.023;
    this.scene.add(ring);
    for (const [i, azimuth] of AZIMUTHS.entries()) {
      const number = sign(i + 1);
      number.position.copy(polar(1.09 * baseRadius, azimuth));
      this.scene.add(number);
      const joint = tube(0.016, 0.07, material("#4a5561"));
      joint.position.copy(polar(baseRadius, azimuth));
      joint.quaternion.setFromUnitVectors(UP, polar(1, azimuth + Math.PI / 2));
      this.scene.add(joint);
    }
  }

  addPlatform() {
    const corners = AZIMUTHS.map((azimuth) => polar(this.geometry.jointRadius, azimuth));
    const shape = new THREE.Shape(corners.map((corner) => new THREE.Vector2(corner.x, corner.y)));
    const plate = new THREE.ExtrudeGeometry(shape, { depth: 0.008, bevelEnabled: false }).translate(0, 0, -0.004);
    this.platform = new THREE.Group();
    this.platform.add(new THREE.Mesh(plate, material("#5d7389", { transparent: true, opacity: 0.85 })));
    for (const corner of corners) {
      const ball = new THREE.Mesh(new THREE.SphereGeometry(0.015, 24, 16), material("#2f3a45"));
      ball.position.copy(corner);
      this.platform.add(ball);
    }
    this.scene.add(this.platform);
    this.corners = corners;
  }

  addLimbs() {
    this.limbs = AZIMUTHS.map((azimuth) => {
      const limb = { foot: polar(this.geometry.baseRadius, azimuth), paint: material("#c9ccd1", { metalness: 0 }) };
      limb.rod = tube(0.0095, 1, limb.paint);
      limb.sleeve = tube(0.0135, 1, limb.paint);
      this.scene.add(limb.rod, limb.sleeve);
      return limb;
    });
  }

  addDegenerate() {
    this.degenerate = new THREE.Group();
    this.arrows = [...this.corners, null].flatMap(() => [1, -1]).map((sign) => {
      const arrow = new THREE.Group();
      arrow.shaft = new THREE.Mesh(new THREE.CylinderGeometry(0.004, 0.004, 1, 12), new THREE.MeshBasicMaterial({ color: DEGENERATE, transparent: true }));
      arrow.head = new THREE.Mesh(new THREE.ConeGeometry(0.011, 0.03, 16), arrow.shaft.material);
      arrow.add(arrow.shaft, arrow.head);
      arrow.sign = sign;
      this.degenerate.add(arrow);
      return arrow;
    });
    this.ghosts = [1, -1].map((sign) => {
      const outline = new THREE.BufferGeometry().setFromPoints(this.corners);
      const ghost = new THREE.LineLoop(outline, new THREE.LineBasicMaterial({ color: DEGENERATE, transparent: true }));
      ghost.sign = sign;
      this.degenerate.add(ghost);
      return ghost;
    });
    this.scene.add(this.degenerate);
  }

  /** Shows one sample: pose [p, q], axial forces (N) over `forceScale`, twist [v, r_b omega], smallest singular value. */
  show({ pose, forces, forceScale, twist, sigma }) {
    this.platform.position.set(...pose.subarray(0, 3));
    this.platform.quaternion.set(...pose.subarray(3, 7)).normalize();
    this.platform.updateMatrixWorld();
    const joints = this.corners.map((corner) => this.platform.localToWorld(corner.clone()));
    this.limbs.forEach((limb, i) => {
      limb.paint.color.copy(forceColour(forces[i] / forceScale));
      stretch(limb.rod, limb.foot, joints[i]);
      stretch(limb.sleeve, limb.foot, limb.foot.clone().lerp(joints[i], 0.55));
    });
    this.showDegenerate(joints, twist, 1 - sigma / this.singularRegion);
  }

  showDegenerate(joints, twist, nearness) {
    this.degenerate.visible = nearness > 0;
    if (!this.degenerate.visible) return;
    const velocity = new THREE.Vector3(...twist.subarray(0, 3));
    const angular = new THREE.Vector3(...twist.subarray(3, 6)).divideScalar(this.geometry.jointRadius);
    const centre = this.platform.position;
    const points = [...joints, centre.clone()];
    const directions = points.map((point) => angular.clone().cross(point.clone().sub(centre)).add(velocity));
    this.arrows.forEach((arrow, k) => {
      const [point, direction] = [points[k >> 1], directions[k >> 1].clone().multiplyScalar(arrow.sign)];
      const length = REACH * nearness * direction.length();
      arrow.visible = length > 0.02;
      if (!arrow.visible) return;
      const tip = point.clone().addScaledVector(direction.normalize(), length);
      stretch(arrow.shaft, point, tip);
      arrow.head.position.copy(tip);
      arrow.head.quaternion.setFromUnitVectors(UP, direction);
      arrow.shaft.material.opacity = 0.25 + 0.75 * nearness;
    });
    for (const ghost of this.ghosts) {
      const moved = joints.map((joint, i) => joint.clone().addScaledVector(directions[i], ghost.sign * REACH * nearness));
      ghost.geometry.setFromPoints(moved);
      ghost.material.opacity = 0.7 * nearness;
    }
  }
}
