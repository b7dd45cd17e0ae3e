// SPDX-License-Identifier: GPL-3.0-or-later
// What the page uses of three.js; scripts/vendor-libraries bundles it.
export {
  AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, BackSide, FrontSide, Group,
  HemisphereLight, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, OrthographicCamera,
  PerspectiveCamera, Plane, Raycaster, Scene, Vector2, Vector3, Spherical, WebGLRenderer, Box3, SRGBColorSpace,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
