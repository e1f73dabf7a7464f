// SPDX-License-Identifier: BSD-3-Clause
// The programs of the graphics card (GLSL ES 3.00).

/** Points coloured by their height, or all in one colour; the farther away the smaller. */
export const POINTS = {
  vertex: `#version 300 es
    uniform mat4 matrix;
    uniform float size, smallest; // of a point: metres as pixels at w = 1, pixels
    uniform vec2 heights;         // m, of the colours' ends
    uniform vec3 colors[8];
    uniform vec4 single;          // w > 0: all have this colour
    in vec3 position;
    out vec3 color;
    void main() {
      gl_Position = matrix * vec4(position, 1.0);
      gl_PointSize = clamp(size / gl_Position.w, smallest, 8.0 * smallest);
      float s = clamp((position.z - heights.x) / (heights.y - heights.x), 0.0, 1.0) * 7.0;
      int k = int(min(floor(s), 6.0));
      color = single.w > 0.0 ? single.rgb : mix(colors[k], colors[k + 1], s - float(k));
    }`,
  fragment: `#version 300 es
    precision mediump float;
    in vec3 color;
    out vec4 result;
    void main() { result = vec4(color, 1.0); }`,
};

/** Lines of a width in pixels: a rectangle of two triangles for each, turned to the viewer. */
export const LINES = {
  vertex: `#version 300 es
    uniform mat4 matrix;
    uniform vec2 pixels; // of the view
    uniform float width; // pixels
    uniform vec4 statuses[5];
    uniform float by_status;
    in vec4 from, to;
    in vec4 color;
    out vec4 drawn;
    out float edge;      // from -1 to 1 across the line,
    out float half_width; // which is so many pixels wide on either side
    void main() {
      vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1) * 2.0 - 1.0);
      vec4 a = matrix * vec4(from.xyz, 1.0), b = matrix * vec4(to.xyz, 1.0);
      // What lies behind the eye is cut off, or the line would come out on the wrong side.
      float nearest = 0.01;
      if (a.w < nearest) a = mix(a, b, (nearest - a.w) / (b.w - a.w));
      if (b.w < nearest) b = mix(b, a, (nearest - b.w) / (a.w - b.w));
      vec2 along = (b.xy / b.w - a.xy / a.w) * pixels;
      float span = length(along);
      vec2 across = span > 1e-4 ? vec2(-along.y, along.x) / span : vec2(0.0, 1.0);
      vec4 at = corner.x < 0.5 ? a : b;
      // The fourth number of a pose: its status, and 8 more when poses are missing before it.
      int status = int(to.w) & 7;
      bool gap = int(to.w) >= 8;
      vec4 of_status = gap ? statuses[4] : statuses[status];
      drawn = by_status > 0.5 ? of_status : color;
      float wide = by_status > 0.5 && gap ? 0.4 * width : width;
      // A pixel more on either side, over which it fades: smooth without multisampling.
      half_width = 0.5 * wide + 1.0;
      edge = corner.y;
      at.xy += across * corner.y * 2.0 * half_width / pixels * at.w;
      gl_Position = at.w < nearest ? vec4(2.0, 2.0, 2.0, 1.0) : at;
    }`,
  fragment: `#version 300 es
    precision mediump float;
    in vec4 drawn;
    in float edge, half_width;
    out vec4 result;
    void main() {
      float inside = clamp((1.0 - abs(edge)) * half_width - 0.5, 0.0, 1.0);
      result = vec4(drawn.rgb, drawn.a * inside);
    }`,
};

export function compile(gl, { vertex, fragment }) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source.replace(/^\s+#/, "#"));
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const uniforms = {}, attributes = {};
  for (let k = 0; k < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++k) {
    const { name } = gl.getActiveUniform(program, k);
    uniforms[name.replace("[0]", "")] = gl.getUniformLocation(program, name);
  }
  for (let k = 0; k < gl.getProgramParameter(program, gl.ACTIVE_ATTRIBUTES); ++k) {
    const { name } = gl.getActiveAttrib(program, k);
    attributes[name] = gl.getAttribLocation(program, name);
  }
  return { program, uniforms, attributes };
}
