// Uses the installed library from its top, so that everything below must be found at link time, and runs a
// part that needs no driver.
#include <plisse/base/version.h>
#include <plisse/io/png.h>
#include <plisse/pipeline.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc > 1) {  // never in the test; the linker does not know
    pipeline::RenderRequest request;
    request.scene.model.path = argv[1];
    pipeline::render(request, {});
  }
  const auto png = plisse::io::encode_png({2, 1, {255, 0, 0, 255, 0, 0, 255, 255}});
  std::cout << "plisse " << plisse::version << ": a PNG of " << png.size() << " bytes\n";
  return png.size() > 60 && png[1] == 'P' ? 0 : 1;
}
