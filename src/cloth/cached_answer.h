// Answers of a SolvedCache as the structs that they are, with the seconds that their solve took.
#pragma once

#include <optional>

#include "base/clock.h"
#include "cloth/archive.h"
#include "cloth/solved_cache.h"

namespace plisse::cloth {

inline constexpr double worth_keeping_s = 0.002;  // looking a solution up takes about as long

template <typename Answer>
std::optional<Answer> answered(const SolvedCache& cache, const Hash& question, Reuse& reuse) {
  const double began = wall_seconds();
  const auto bytes = cache.find(question);
  if (!bytes) return std::nullopt;
  double seconds = 0;
  Answer answer;
  Reader reader(*bytes);
  reader(seconds, answer);
  if (!reader.at_end()) return std::nullopt;
  ++reuse.answers;
  reuse.saved_s += seconds - (wall_seconds() - began);
  return answer;
}

template <typename Answer>
void keep(const SolvedCache& cache, const Hash& question, const Answer& answer, double seconds) {
  if (seconds < worth_keeping_s) return;
  Writer writer;
  writer(seconds, answer);
  cache.keep(question, writer.bytes());
}

}  // namespace plisse::cloth
