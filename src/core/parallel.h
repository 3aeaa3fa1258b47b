#pragma once

/// Parallel loops with results independent of the number of threads: every index writes its own output, and
/// sums are taken over fixed blocks in a fixed order.

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace ebru {

namespace detail {

/// What a thread did before releasedAt(place) has happened for one that calls acquiredAt(place) later. Does nothing but tell
/// ThreadSanitizer, which does not see how oneTBB's library orders the bodies of a loop and its end.
#ifdef __SANITIZE_THREAD__
inline void releasedAt(char& place) { __tsan_release(&place); }
inline void acquiredAt(char& place) { __tsan_acquire(&place); }
#else
inline void releasedAt(char&) {}
inline void acquiredAt(char&) {}
#endif

}  // namespace detail

/// Calls body(i) for every i in [0, count), concurrently. `grain` is the number of indices worth a task.
template <class Body>
void parallelFor(std::size_t count, std::size_t grain, const Body& body) {
  char loop = 0;
  detail::releasedAt(loop);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      detail::acquiredAt(loop);
                      for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
                      detail::releasedAt(loop);
                    });
  detail::acquiredAt(loop);
}

/// Calls body(begin, end) for consecutive blocks of `block` indices, concurrently; for bodies with scratch memory.
template <class Body>
void parallelBlocks(std::size_t count, std::size_t block, const Body& body) {
  parallelFor((count + block - 1) / block, 1,
              [&](std::size_t b) { body(b * block, std::min(count, (b + 1) * block)); });
}

/// One object of scratch memory for each thread that asks, made by `make`; results must not depend on what it was used for
/// before.
template <class Scratch>
class PerThread {
 public:
  template <class Make>
  explicit PerThread(const Make& make) : objects_(make) {}
  Scratch& local() { return objects_.local(); }

 private:
  tbb::enumerable_thread_specific<Scratch> objects_;
};

/// Sum of term(i) over [0, count), in double, in an order that does not depend on the threads.
template <class Term>
double parallelSum(std::size_t count, const Term& term) {
  constexpr std::size_t block = 4096;
  std::vector<double> partial((count + block - 1) / block, 0.0);
  parallelBlocks(count, block, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += term(i);
    partial[begin / block] = sum;
  });
  double total = 0.0;
  for (double p : partial) total += p;
  return total;
}

/// Limits all parallel loops to `threads` while it lives; 0 leaves the machine's number.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_ = nullptr;
};

}  // namespace ebru
