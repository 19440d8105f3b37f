// Reason: every frame needs the same large buffers. If they were returned to the kernel between frames, their
// pages would be mapped and zeroed again each time, which was a fifth of a run's CPU time. With pages of 4
// KiB the first access to a picture of 1280 × 1024 with four samples causes 12,000 page faults, which was a
// third of the time to the first frame.
#include "base/heap.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#endif

namespace plisse {

#ifdef __GLIBC__
namespace {

// Whether unused address space costs nothing: there is no limit on it (ulimit -v, batch systems), which
// threads and drivers would have to share, and the kernel does not count reserved memory as used
// (overcommit).
bool address_space_is_free() {
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY) return false;
  }
  constexpr int never_overcommit = 2;
  int policy = never_overcommit;
  std::ifstream("/proc/sys/vm/overcommit_memory") >> policy;
  return policy != never_overcommit;
}

}  // namespace
#endif

void prepare_heap() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the maximum: smaller blocks come from the heap
  mallopt(M_TRIM_THRESHOLD, 1 << 30);   // up to 1 GiB of free memory stays with the process
  if (!address_space_is_free()) return;
  // The heap's first part in large pages; it is only address space until it is used.
  constexpr int reserve = 512 << 20, default_padding = 128 << 10;
  mallopt(M_TOP_PAD, reserve);
  constexpr std::size_t large_page = 2 << 20;
  void* const block = std::malloc(large_page);
  mallopt(M_TOP_PAD, default_padding);
  const auto first = (reinterpret_cast<std::uintptr_t>(block) + large_page - 1) / large_page * large_page;
  const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0));
  if (block != nullptr && first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
  std::free(block);
#endif
}

void share_heap() {
#ifdef __GLIBC__
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_MAX, 0);
#endif
}

}  // namespace plisse
