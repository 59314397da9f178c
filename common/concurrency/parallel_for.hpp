// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

#include "common/concurrency/other_processor.hpp"

namespace rds::concurrency {

/// A loop whose iterations run on the calling thread and on one more, which sleeps in between.
class ParallelFor {
 public:
  ParallelFor();

  /// Calls part(0) … part(count − 1), each once, on both threads, in any order; returns when
  /// all are done. Where the second thread gets no processor, the caller does everything. To be called by one
  /// thread at a time, not from a part.
  /// @throws what a part threw first; parts not begun by then are left out.
  void run(std::size_t count, const std::function<void(std::size_t)>& part);

 private:
  void help(const std::stop_token& stop);
  void do_parts();

  std::mutex mutex_;
  std::condition_variable_any changed_;
  const std::function<void(std::size_t)>* part_ = nullptr;
  std::size_t count_ = 0;
  std::size_t next_ = 0;   // part that nobody has begun
  std::size_t begun_ = 0;  // parts that are being done
  std::exception_ptr failure_;
  std::jthread thread_;  // it uses the members above
  OtherProcessor processor_;
};

}  // namespace rds::concurrency
