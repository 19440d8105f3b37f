// Settings of the C library's heap for runs that need large buffers from start to end.
#pragma once

namespace plisse {

// The heap keeps freed memory and grows in large pages. For programs, once, at the start of main(): a library
// must not change its caller's heap. Does nothing where the C library is not glibc.
void prepare_heap();

// From now on all threads use one heap for blocks of any size, provided that only the first thread has
// allocated so far. For work whose threads pass each other a few large blocks, which would otherwise be
// mapped and unmapped for every picture. Not for threads that allocate much, nor for solvers whose blocks
// grow: memory that they free stays in the heap.
void share_heap();

}  // namespace plisse
