#include "pipeline/picture.h"

#include "io/picture/png.h"

namespace plisse::pipeline {

std::pair<std::vector<std::uint8_t>, bool> Picture::png(const std::string& hash) {
  bool compressed = false;
  std::call_once(once_, [&] {
    png_ = io::encode_png(image_);
    image_ = {};
    compressed = true;
  });
  return {hash.empty() ? png_ : io::with_hash(png_, hash), compressed};
}

}  // namespace plisse::pipeline
