#include "passes/profile.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>

#include "base/error.h"
#include "mesh/wave_profiles.h"

namespace plisse::passes {
namespace {

constexpr double pi = std::numbers::pi;

[[noreturn]] void fail(const std::string& text) {
  throw Error(ExitCode::bad_input, text);
}

std::vector<double> read_table(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    fail(fmt::format("profile '{}': neither {}, and no such file can be read", path,
                     fmt::join(wave_profile_names(), " nor ")));
  }
  std::vector<double> values;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const char* at = line.data();
    const char* end = at + std::min(line.size(), line.find('#'));
    while (true) {
      while (at != end && (std::isspace(static_cast<unsigned char>(*at)) || *at == ',')) ++at;
      if (at == end) break;
      double value = 0;
      const auto [next, problem] = std::from_chars(at, end, value);
      if (problem != std::errc() || !std::isfinite(value)) {
        fail(
            fmt::format("{}:{}:{}: not a finite number; a profile is a list of numbers, one period of f from "
                        "its crest on",
                        path, number, at - line.data() + 1));
      }
      values.push_back(value);
      at = next;
    }
  }
  if (values.size() < 4 || values.size() > 65536) {
    fail(fmt::format("{}: {} numbers; a profile has 4 to 65536", path, values.size()));
  }
  return values;
}

// Scaled to −1…1 and checked to be even: f(φ) = f(−φ).
std::vector<double> normalised_table(const std::string& path) {
  std::vector<double> values = read_table(path);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double middle = (*low + *high) / 2, half = (*high - *low) / 2;
  if (!(half > 0)) fail(fmt::format("{}: all numbers are equal; a profile must rise and fall", path));
  for (double& value : values) value = (value - middle) / half;
  for (std::size_t i = 1; i < values.size(); ++i) {
    // 1e-3 of the half height: a table written with four digits passes.
    if (std::abs(values[i] - values[values.size() - i]) > 1e-3) {
      fail(fmt::format(
          "{}: not even: number {} and number {} differ, but f(phase) must equal f(-phase), because the "
          "direction of a wave has no sign; start the period at a crest that is symmetric",
          path, i + 1, values.size() - i + 1));
    }
  }
  return values;
}

}  // namespace

Profile make_profile(const std::string& name) {
  Profile profile;
  profile.f.resize(Profile::size);
  profile.derivative.resize(Profile::size);
  const auto fill = [&](auto&& f, auto&& derivative) {
    for (int i = 0; i < Profile::size; ++i) {
      const double phase =
          2 * pi * (i <= Profile::size / 2 ? i : i - Profile::size) / Profile::size;  // (−π, π]
      profile.f[static_cast<std::size_t>(i)] = f(phase);
      profile.derivative[static_cast<std::size_t>(i)] = derivative(phase);
    }
  };
  if (const WaveProfile* known = find_wave_profile(name)) {
    fill(known->f, known->derivative);
  } else {
    const std::vector<double> table = normalised_table(name);
    const auto at = [&](double phase) {
      const double count = static_cast<double>(table.size());
      double place = phase / (2 * pi) * count;
      place -= std::floor(place / count) * count;
      const std::size_t i = std::min(static_cast<std::size_t>(place), table.size() - 1);
      return std::lerp(table[i], table[(i + 1) % table.size()], place - static_cast<double>(i));
    };
    const double step = 2 * pi / static_cast<double>(std::max<std::size_t>(table.size(), Profile::size));
    fill(at, [&](double p) { return (at(p + step) - at(p - step)) / (2 * step); });
  }
  double sum = 0;
  for (double slope : profile.derivative) sum += slope * slope;
  profile.slope_variance = sum / Profile::size / 0.5;
  return profile;
}

Profile with_finer_waves(Profile profile, int waves, double share) {
  if (waves == 0 || share == 0) return profile;
  profile.fine_waves = waves;
  profile.coarse = 1 / std::sqrt(1 + share * share);
  profile.fine = profile.coarse * share / waves;
  return profile;
}

}  // namespace plisse::passes
