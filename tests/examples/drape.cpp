// A sheet of cloth hangs by two corners.
#include <plisse/drape.h>

#include <algorithm>
#include <iostream>

int main() {
  constexpr std::uint32_t n = 10;  // squares a side of half a metre
  plisse::DrapeRequest request;
  plisse::Cloth& cloth = request.cloth.emplace();
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) cloth.rest.push_back({0.5 * i / n, 0, 0.5 * j / n});
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      cloth.triangles.push_back({a, c, b});
      cloth.triangles.push_back({a, d, c});
    }
  cloth.held.assign(cloth.rest.size(), 0);
  cloth.held[0] = cloth.held[n] = 1;
  cloth.material = {1e5, 0.3, 1e-3, 200};
  cloth.gravity = {0, -9.81, 0};

  double lowest = 0;
  request.on_frame = [&](const plisse::DrapeFrame& frame, const plisse::BaseSurface& base) {
    for (const plisse::Vector3& x : base.positions) lowest = std::min(lowest, x[1]);
    std::cout << frame.iterations << " steps, " << frame.energy << " J: " << frame.reason << '\n';
  };
  const plisse::DrapeReport report = plisse::drape(request);
  std::cout << "hangs down " << -lowest << " m\n";
  return report.converged && lowest < -0.3 ? 0 : 1;  // more than half its length
}
