// t = d / r at a fragment, by the heights of a field in a texture: from p' = p - d n a ray is followed
// from cell to cell, as by vizlight/geometry/relief/shadowing.py. Places are in cells, with heights
// above the origin, distances along rays in the unit of the mesh.
float viz_below(float f0, float f1, float f2, float end) {
  float square = f1 * f1 - 4.0 * f0 * f2;
  float q = -0.5 * (f1 + (f1 < 0.0 ? -1.0 : 1.0) * sqrt(max(square, 0.0)));
  if (square < 0.0 || q == 0.0) return max(f0, f0 + f2) > 0.0 ? end : 0.0;
  float first = clamp(f0 / q, 0.0, end);
  float second = f2 != 0.0 ? clamp(q / f2, 0.0, end) : (q > 0.0 ? end : 0.0);
  float between = abs(first - second);
  return f2 >= 0.0 ? end - between : between;
}
float viz_height(sampler2D field, ivec2 node) {
  return texelFetch(field, clamp(node, ivec2(0), ivec2(vizFieldSize.xy) - 1), 0).r;
}
vec4 viz_cell(sampler2D field, ivec2 cell) {
  return vec4(viz_height(field, cell), viz_height(field, cell + ivec2(1, 0)),
    viz_height(field, cell + ivec2(0, 1)), viz_height(field, cell + ivec2(1, 1)));
}
float viz_bilinear(vec4 h, vec2 at) {
  return mix(mix(h.x, h.y, at.x), mix(h.z, h.w, at.x), at.y);
}
vec3 viz_in_field(vec3 v) {
  return vec3(vizFieldX.w * dot(vizFieldX.xyz, v), vizFieldY.w * dot(vizFieldY.xyz, v),
    vizFieldZ.w * dot(vizFieldZ.xyz, v));
}
vec2 viz_edges(ivec2 cell, vec2 start, vec2 way) {
  ivec2 last = ivec2(vizFieldSize.xy) - 1;
  vec2 away = vec2(1e30);
  for (int a = 0; a < 2; ++a) {
    if (way[a] > 0.0 && cell[a] < last[a]) away[a] = (float(cell[a] + 1) - start[a]) / way[a];
    if (way[a] < 0.0 && cell[a] >= 0) away[a] = (float(cell[a]) - start[a]) / way[a];
  }
  return away;
}
float viz_shadow(sampler2D field, vec3 place, vec3 normal, vec3 lamp, float near) {
  if (vizDepth <= 0.0) return max(dot(normal, normalize(lamp - near * place)), 0.0);
  vec3 at = viz_in_field(place - vizFieldFrom);
  ivec2 last = ivec2(vizFieldSize.xy) - 1;
  ivec2 cell = clamp(ivec2(floor(at.xy)), ivec2(0), last - 1);
  float height = viz_bilinear(viz_cell(field, cell), clamp(at.xy - vec2(cell), 0.0, 1.0));
  // The place on the field, which the drawn mesh may show flat.
  vec3 from = place + (height - at.z) / vizFieldZ.w * vizFieldZ.xyz - vizDepth * normal;
  vec3 toward = lamp - near * from;
  float reach = near > 0.0 ? length(toward) : 1e9;
  toward = normalize(toward);
  vec3 start = viz_in_field(from - vizFieldFrom);
  vec3 way = viz_in_field(toward);
  // Within a cell on each side the solid is the space below the tangent plane.
  float cosine = dot(normal, toward);
  float s = reach;
  for (int a = 0; a < 2; ++a) {
    if (abs(start[a] - at[a]) > 1.0) s = 0.0;
    else if (way[a] != 0.0) s = min(s, (at[a] + sign(way[a]) - start[a]) / way[a]);
  }
  float inside = min(s, cosine > 0.0 ? vizDepth / cosine : 1e9);
  float end = reach;
  float top = vizFieldSize.z - start.z;
  if (way.z > 0.0) end = min(end, top / way.z);
  else if (way.z < 0.0) s = max(s, top / way.z);
  else if (top <= 0.0) end = s;
  cell = clamp(ivec2(floor(start.xy + min(s, 1e6) * way.xy)), ivec2(-1), last);
  for (int i = 0; i < 16384; ++i) {
    if (s >= end) break;
    vec2 edges = viz_edges(cell, start.xy, way.xy);
    float leave = min(max(min(edges.x, edges.y), s), end);
    vec2 z = start.z + vec2(s, leave) * way.z;
    vec4 h = viz_cell(field, cell);
    if (max(z.x, z.y) <= min(min(h.x, h.y), min(h.z, h.w))) inside += leave - s;
    else if (min(z.x, z.y) < max(max(h.x, h.y), max(h.z, h.w))) {
      vec2 u = start.xy + s * way.xy - vec2(cell);
      vec3 slope = vec3(h.y - h.x, h.z - h.x, h.w - h.z - h.y + h.x);
      inside += viz_below(h.x - z.x + u.x * slope.x + u.y * (slope.y + u.x * slope.z),
        way.x * (slope.x + u.y * slope.z) + way.y * (slope.y + u.x * slope.z) - way.z,
        way.x * way.y * slope.z, leave - s);
    }
    s = leave;
    if (edges.x <= edges.y) cell.x += way.x < 0.0 ? -1 : 1;
    else cell.y += way.y < 0.0 ? -1 : 1;
  }
  return vizDepth / max(inside, vizDepth);
}
