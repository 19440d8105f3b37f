// How the C library's heap is kept for runs that need large buffers from start to end.
#pragma once

namespace plisse {

// Lets the heap keep what is freed, and grow in large pages. For programs, once, at the start of main(): a
// library has no business with its caller's heap. Where the C library is not glibc nothing happens.
void prepare_heap();

}  // namespace plisse
