// The power of a number in [0, 1] from its deficit; near 1 by a series, because GLSL has no log1p.
float viz_power(float x, float deficit, float exponent) {
  if (x <= 0.0) return exponent > 0.0 ? 0.0 : 1.0;
  float series = deficit * (1.0 + deficit * (0.5 + deficit * (1.0 / 3.0 + deficit * (0.25
    + deficit * (0.2 + deficit / 6.0)))));
  return exp(exponent * (deficit < 0.1 ? -series : log(x)));
}
