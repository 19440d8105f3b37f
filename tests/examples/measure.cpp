// The waves of a corrugated sheet, over the flat one.
#include <plisse/measure.h>

#include <cmath>
#include <iostream>

// One square metre, 80 × 80 squares, waves of 10 cm and 1 cm high along x.
plisse::Mesh sheet(double amplitude) {
  constexpr std::uint32_t n = 80;
  plisse::Mesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double x = double(i) / n, y = double(j) / n;
      mesh.positions.push_back({x, y, amplitude * std::cos(2 * 3.14159265358979 * x / 0.1)});
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

int main() {
  const plisse::WaveSpectrum spectrum = plisse::measure(sheet(0.01), sheet(0));
  if (spectrum.waves.empty()) return 1;
  const plisse::Wave& wave = spectrum.waves.front();
  std::cout << 1000 * wave.wavelength << " mm long, " << 1000 * wave.amplitude << " mm high, " << wave.count
            << " crests\n";
  // What <plisse/measure.h> promises for eight vertices a wave: 1 % of the length, 5 % of the height.
  return std::abs(wave.wavelength - 0.1) < 0.001 && std::abs(wave.amplitude - 0.01) < 0.0005 ? 0 : 1;
}
