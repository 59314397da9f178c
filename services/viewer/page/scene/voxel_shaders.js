// SPDX-License-Identifier: Apache-2.0
// How a voxel looks: a cube near by, a square of its size where it is small. A mesh stands at its chunk's corner, in the map's frame.

const LOOK = `
  attribute vec4 voxel;  // place and, in bit 15, whether there is one above; red + 256 green; blue + 256 certainty; label
  uniform float side;    // of a voxel [m]
  uniform vec2 heights;  // lowest, highest [m]
  uniform int mode;
  uniform float dimmed;  // label that alone is bright, or -1
  uniform sampler2D labels;
  varying vec3 tone;
  vec3 ramp(float t) {  // viridis, by a polynomial
    const vec3 a = vec3(0.2777, 0.0054, 0.3341), b = vec3(0.1051, 1.4046, 1.3846), c = vec3(-0.3309, 0.2148, 0.0951), d = vec3(-4.6342, -5.7991, -19.3324), e = vec3(6.2283, 14.1799, 56.6906), f = vec3(4.7764, -13.7451, -65.3530), g = vec3(-5.4355, 4.6459, 26.3124);
    return clamp(a + t * (b + t * (c + t * (d + t * (e + t * (f + t * g))))), 0.0, 1.0);
  }
  vec3 middle() {  // from the chunk's corner
    float place = mod(voxel.x, 32768.0);
    return (vec3(mod(place, 32.0), mod(floor(place / 32.0), 32.0), floor(place / 1024.0)) + 0.5) * side;
  }
  vec3 eye() {  // from the chunk's corner
    return -(transpose(mat3(modelViewMatrix)) * modelViewMatrix[3].xyz);
  }
  vec3 up() {
    return vec3(modelMatrix[0].z, modelMatrix[1].z, modelMatrix[2].z);
  }
  vec3 lit(vec3 center, vec3 normal) {
    vec3 color = vec3(mod(voxel.y, 256.0), floor(voxel.y / 256.0), mod(voxel.z, 256.0)) / 255.0;
    if (mode == 1) {
      vec3 of_label = texture2D(labels, vec2((mod(voxel.w, 64.0) + 0.5) / 64.0, (floor(voxel.w / 64.0) + 0.5) / 64.0)).rgb;
      color = voxel.w > 0.5 ? of_label : mix(vec3(0.62, 0.65, 0.69), vec3(dot(color, vec3(0.3, 0.59, 0.11))), 0.45);
    } else if (mode == 2) {
      color = ramp(clamp(((modelMatrix * vec4(center, 1.0)).z - heights.x) / max(heights.y - heights.x, 1e-3), 0.0, 1.0));
    } else if (mode == 3) {
      color = ramp(floor(voxel.z / 256.0) / 255.0);
    }
    if (dimmed >= 0.0 && abs(voxel.w - dimmed) > 0.5) color = mix(color, vec3(dot(color, vec3(0.33))), 0.85) * 0.5;
    return color * (0.80 + 0.20 * dot(normal, up()) + 0.07 * dot(normal, normalize(vec3(0.8, 0.35, 0.5))));
  }`;

// Three faces that meet in a corner: of a cube no more can be seen. The shader mirrors them towards the eye.
export const CORNER = new Float32Array([1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, -1, 1, -1, -1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1]);
export const INDEX = [0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7, 8, 9, 10, 8, 10, 11];

export const CUBE = {
  vertexShader: `${LOOK}
  varying vec2 face;
  void main() {
    vec3 center = middle();
    vec3 towards = sign(eye() - center);
    vec3 normal = gl_VertexID < 4 ? vec3(towards.x, 0.0, 0.0) : gl_VertexID < 8 ? vec3(0.0, towards.y, 0.0) : vec3(0.0, 0.0, towards.z);
    face = gl_VertexID < 4 ? position.yz : gl_VertexID < 8 ? position.xz : position.xy;
    tone = lit(center, normal);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(center + position * towards * (0.5 * side), 1.0);
  }`,
  fragmentShader: `
  varying vec3 tone;
  varying vec2 face;
  void main() {
    vec2 width = fwidth(face) * 1.1;
    vec2 edge = smoothstep(vec2(1.0) - width, vec2(1.0), abs(face));
    float near = 1.0 - smoothstep(0.08, 0.3, max(width.x, width.y));  // far voxels are smaller than a line
    gl_FragColor = vec4(tone * (1.0 - 0.22 * near * max(edge.x, edge.y)), 1.0);
  }`,
};

export const SQUARE = {
  vertexShader: `${LOOK}
  uniform float pixels;  // of 1 m at a distance of 1 m
  uniform float least;   // [px]
  void main() {
    vec3 center = middle(), away = eye() - center;
    vec3 beside = abs(away.x) > abs(away.y) ? vec3(sign(away.x), 0.0, 0.0) : vec3(0.0, sign(away.y), 0.0);
    tone = lit(center, voxel.x < 32768.0 && dot(away, up()) > 0.0 ? up() : beside);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(center, 1.0);
    gl_PointSize = max(1.2 * pixels * side / gl_Position.w, least > 1.0 ? 1.35 * least : 1.0);  // few ones overlap, or gaps show
  }`,
  fragmentShader: `
  varying vec3 tone;
  void main() {
    gl_FragColor = vec4(tone, 1.0);
  }`,
};
