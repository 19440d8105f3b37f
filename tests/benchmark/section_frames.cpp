#include <algorithm>

#include "benchmark/film.h"
#include "benchmark/sections.h"

namespace plisse::benchmark {

void measure_frames(Report& report, const Effort& effort) {
  Table table{
      "Whole frames",
      "A scene of assets/ as it stands, whole clip, pose to picture. *With PNG*: `plisse::render`, files "
      "written beside "
      "and renamed, from the second frame on. *Read back*: the same into memory. CPU time is of all threads.",
      {"scene", "MSAA", "output", "frames/s", "CPU ms per frame", "frames/s, loading included"},
      {}};
  const int runs = std::min(effort.samples, 3);
  for (const char* name : {"sleeve", "shirt", "zeppelin"}) {
    const config::SceneSettings settings = film_settings(name, effort, 4);
    std::vector<double> fps[2], cpu[2], whole;
    for (int run = 0; run < runs; ++run) {
      const FilmWithFiles film = film_with_files(settings, effort);
      fps[0].push_back(1 / film.frame.wall_s);
      cpu[0].push_back(1e3 * film.frame.cpu_s);
      whole.push_back(film.whole_run_fps);
      const gpu::Context context;
      const Sample sample = film_without_files(settings, effort, true, context.info().software);
      fps[1].push_back(1 / sample.wall_s);
      cpu[1].push_back(1e3 * sample.cpu_s);
    }
    table.rows.push_back({name, "4×", "with PNG", Cell(distribution(fps[0]), 1),
                          Cell(distribution(cpu[0]), 1), Cell(distribution(whole), 1)});
    table.rows.push_back(
        {name, "4×", "read back", Cell(distribution(fps[1]), 1), Cell(distribution(cpu[1]), 1), Cell("")});
  }
  report.tables.push_back(table);
}

}  // namespace plisse::benchmark
