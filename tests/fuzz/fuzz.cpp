// libFuzzer's way in: PLISSE_FUZZ_READER is one of support/readers.h. Anything but an Error ends the run and
// leaves the bytes that did it; tools/fuzz builds and runs these.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "base/log.h"
#include "support/files.h"
#include "support/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const plisse::test::TemporaryFolder folder;
  plisse::log::set_level(plisse::log::Level::quiet);
  try {
    PLISSE_FUZZ_READER({reinterpret_cast<const char*>(data), size}, folder.path());
  } catch (const plisse::Error&) {
  }
  return 0;
}
