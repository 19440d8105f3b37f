#include "bench/suite.h"

#include "config/scene_file.h"
#include "io/picture/png.h"

namespace plisse::bench {

config::SceneSettings Setup::scene(const std::string& name, int width, int height) const {
  config::SceneSettings settings = config::load_scene((assets / (name + ".toml")).string());
  settings.output.width = width;
  settings.output.height = height;
  settings.model.loop = false;
  return settings;
}

void Setup::save(SuiteReport& report, const std::string& name, const io::Image& image,
                 const std::string& caption) const {
  const std::string path = "pictures/" + name + ".png";
  io::write_png(folder / path, image, {io::PngLevel::small, ""});
  report.pictures.push_back({path, caption});
}

void mark_fronts(std::vector<Row>& rows) {
  for (Row& row : rows) {
    row.on_front = true;
    for (const Row& other : rows) {
      if (other.scene != row.scene || other.error_of != row.error_of || other.error_unit != row.error_unit ||
          other.seconds_of != row.seconds_of || other.clock != row.clock)
        continue;
      const bool as_good = other.seconds.median <= row.seconds.median && other.error <= row.error;
      const bool better = other.seconds.median < row.seconds.median || other.error < row.error;
      if (as_good && better) row.on_front = false;
    }
  }
}

}  // namespace plisse::bench
