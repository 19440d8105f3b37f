// How the C library's heap is kept for runs that need large buffers from start to end.
#pragma once

namespace plisse {

// Lets the heap keep what is freed, and grow in large pages. For programs, once, at the start of main(): a
// library has no business with its caller's heap. Where the C library is not glibc nothing happens.
void prepare_heap();

// From now on one heap for all threads and for blocks of any size, as long as no thread but the first has
// allocated: for work whose threads hand each other a few large blocks, which would be mapped and unmapped
// for every picture. Not for threads that allocate much, nor for solvers whose blocks grow: what they leave
// behind in a heap is not handed back.
void share_heap();

}  // namespace plisse
