// plisse bench hard: difficult cases for programs of this kind, each with its required result. The tests run
// the same list.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace plisse::bench {

struct Verdict {
  bool holds = false;
  std::string found;  // the result, in words and numbers
};

struct HardCase {
  std::string area;  // passes | sizing | drape | wrinkle
  std::string name, must;
  bool draws = false;            // needs an OpenGL context, which it makes itself
  std::function<Verdict()> run;  // an exception counts as a failure
};

const std::vector<HardCase>& hard_cases();

struct HardRow {
  std::string area, name, must;
  Verdict verdict;
  double seconds = 0;
};

// Runs one case; an exception becomes its verdict.
HardRow judge(const HardCase& hard);

std::string hard_markdown(const std::vector<HardRow>& rows);

// The parts of the list.
std::vector<HardCase> hard_passes();
std::vector<HardCase> hard_scenes();
std::vector<HardCase> hard_sizing();
std::vector<HardCase> hard_shells();  // drape and wrinkle

}  // namespace plisse::bench
