// SPDX-License-Identifier: Apache-2.0
// The thread sanitizer of GCC 12 sees every function of POSIX that locks a mutex but this one, by which Fast
// DDS takes its timed mutexes; without it all that they guard looks unguarded. So here it is, made of one
// that is seen.
#include <algorithm>
#include <chrono>
#include <ctime>

#include <pthread.h>

namespace {

using std::chrono::nanoseconds;
using std::chrono::seconds;

constexpr seconds kForEver{1'000'000'000};  // added to any clock it does not overflow

nanoseconds time_on(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return seconds(now.tv_sec) + nanoseconds(now.tv_nsec);
}

/// The moment `deadline` of `clock`, on the clock that pthread_mutex_timedlock uses.
timespec on_real_time_clock(clockid_t clock, const timespec& deadline) {
  const nanoseconds left =
      std::min(seconds(deadline.tv_sec), kForEver) + nanoseconds(deadline.tv_nsec) - time_on(clock);
  const nanoseconds real = time_on(CLOCK_REALTIME) + std::max(left, nanoseconds(0));
  const seconds whole = std::chrono::duration_cast<seconds>(real);
  return {whole.count(), (real - whole).count()};
}

}  // namespace

extern "C" int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock,
                                       const timespec* deadline) noexcept {
  const timespec real_deadline = on_real_time_clock(clock, *deadline);
  return pthread_mutex_timedlock(mutex, &real_deadline);
}
