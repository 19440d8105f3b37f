// The waves of a twisted cylinder: draped, solved, and as geometry.
#include <plisse/wrinkle.h>

#include <algorithm>
#include <iostream>

int main() {
  plisse::WrinkleRequest request;
  plisse::DrapeRequest twist;
  twist.example = "twisted-cylinder";
  twist.vertices = 200;
  twist.on_frame = [&](const plisse::DrapeFrame&, const plisse::BaseSurface& base) { request.base = base; };
  if (!plisse::drape(twist).converged) return 1;

  request.mesh = true;
  request.levels = 2;
  const plisse::WrinkleResult result = plisse::solve_wrinkles(request);
  const double highest = *std::max_element(result.field.amplitude.begin(), result.field.amplitude.end());
  std::cout << result.waves << " waves, at most " << 1000 * highest << " mm high: " << result.reason << '\n';
  plisse::save_field("field.ply", result.field);
  // Each level makes four triangles of one.
  const bool fine = result.mesh.triangles.size() == 16 * request.base.triangles.size();
  return result.waves > 1 && fine && plisse::load_field("field.ply").amplitude == result.field.amplitude ? 0
                                                                                                         : 1;
}
