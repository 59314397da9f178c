// SPDX-License-Identifier: Apache-2.0
// Preloaded into a program (LD_PRELOAD), it is the clock of a machine that is set wrong: the time of day is
// RDS_CLOCK_SHIFT_S seconds later than it is, and who waits until a time of day waits by that clock; time
// that only goes on (CLOCK_MONOTONIC) is as it is.
#include <cstdlib>
#include <ctime>

#include <pthread.h>
#include <semaphore.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

time_t shift_s() {
  static const time_t kShift = [] {
    const char* shift = std::getenv("RDS_CLOCK_SHIFT_S");
    return shift == nullptr ? time_t{0} : static_cast<time_t>(std::atoll(shift));
  }();
  return kShift;
}

/// Until when somebody waits. Which clock it is by is an attribute of what he waits for, and cannot be asked;
/// but days are counted from 1970, and the other clock from when the machine was started.
struct Deadline {
  explicit Deadline(const timespec* asked) : at(*asked) {
    constexpr time_t kYear2001 = 1'000'000'000;
    if (at.tv_sec < kYear2001) return;
    clock = CLOCK_REALTIME;
    at.tv_sec -= shift_s();
  }
  clockid_t clock = CLOCK_MONOTONIC;
  timespec at;
};

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  const auto result = static_cast<int>(syscall(SYS_clock_gettime, clock, now));
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) now->tv_sec += shift_s();
  return result;
}

int gettimeofday(timeval* now, void* /*zone*/) noexcept {
  timespec precise{};
  const int result = clock_gettime(CLOCK_REALTIME, &precise);
  now->tv_sec = precise.tv_sec;
  now->tv_usec = precise.tv_nsec / 1000;
  return result;
}

time_t time(time_t* now) noexcept {
  timespec precise{};
  clock_gettime(CLOCK_REALTIME, &precise);
  if (now != nullptr) *now = precise.tv_sec;
  return precise.tv_sec;
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
  const Deadline deadline(until);
  return pthread_cond_clockwait(condition, mutex, deadline.clock, &deadline.at);
}

int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* until) noexcept {
  const Deadline deadline(until);
  return pthread_mutex_clocklock(mutex, deadline.clock, &deadline.at);
}

int sem_timedwait(sem_t* semaphore, const timespec* until) {
  const Deadline deadline(until);
  return sem_clockwait(semaphore, deadline.clock, &deadline.at);
}
}
