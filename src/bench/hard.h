// plisse bench hard: cases that break programs of this kind, each with the outcome that it must have. The
// same list runs in the tests.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace plisse::bench {

struct Verdict {
  bool holds = false;
  std::string found;  // what came out, in words and numbers
};

struct HardCase {
  std::string area;  // passes | sizing | drape | wrinkle
  std::string name, must;
  bool draws = false;            // needs an OpenGL context, which it makes itself
  std::function<Verdict()> run;  // an exception is a verdict too: it does not hold
};

const std::vector<HardCase>& hard_cases();

struct HardRow {
  std::string area, name, must;
  Verdict verdict;
  double seconds = 0;
};

// Runs one case; whatever it throws becomes its verdict.
HardRow judge(const HardCase& hard);

std::string hard_markdown(const std::vector<HardRow>& rows);

// The parts of the list.
std::vector<HardCase> hard_passes();
std::vector<HardCase> hard_scenes();
std::vector<HardCase> hard_sizing();
std::vector<HardCase> hard_shells();  // drape and wrinkle

}  // namespace plisse::bench
