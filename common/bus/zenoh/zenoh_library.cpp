// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_library.hpp"

#include <csignal>
#include <cstdlib>

#include <dlfcn.h>

#include "common/bus/participant.hpp"
#include "common/bus/zenoh/links/link_policy.hpp"

namespace rds::bus::detail {
namespace {

/// Zenoh's threads, where the user has not said otherwise. Each reader that is behind holds one of 50 per
/// class, and whoever answers a late joiner or says a heartbeat may wait for him on one of two and of one: a
/// few frozen readers would use them up.
void allow_many_slow_readers() {
  setenv("ZENOH_RUNTIME", "(rx: (worker_threads: 4), net: (worker_threads: 2, max_blocking_threads: 512))",
         0);
}

/// While it lives the threads that are made inherit that SIGPIPE is blocked. Zenoh's write to sockets whose
/// other end has gone, and rely on a signal that only programs in Rust ignore; ours may need it to end behind
/// a pipe.
class BlockedPipeSignal {
 public:
  BlockedPipeSignal() {
    sigset_t pipe_signal;
    sigemptyset(&pipe_signal);
    sigaddset(&pipe_signal, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_signal, &before_);
  }
  ~BlockedPipeSignal() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedPipeSignal(const BlockedPipeSignal&) = delete;
  BlockedPipeSignal& operator=(const BlockedPipeSignal&) = delete;

 private:
  sigset_t before_{};
};

const RdsZenohApi& load() {
  allow_many_slow_readers();
  // The first: where the build puts it, for programs in bin, tests and bench. The second: where the system
  // looks.
  for (const char* file : {"$ORIGIN/../lib/librds_zenoh.so", "librds_zenoh.so"}) {
    void* library = dlopen(file, RTLD_NOW | RTLD_LOCAL);  // never closed: Zenoh keeps threads
    if (library == nullptr) continue;
    const auto api = reinterpret_cast<decltype(rds_zenoh_api)*>(dlsym(library, "rds_zenoh_api"));
    if (api != nullptr && api()->version == RDS_ZENOH_VERSION) {
      api()->listen_to_log(&take_log_line);
      return *api();
    }
    throw BusError("librds_zenoh.so is of another build than this program");
  }
  throw BusError(
      "--bus zenoh: librds_zenoh.so was not found beside this program; the build makes it where there is a "
      "cargo, which tools/setup.sh installs");
}

}  // namespace

const RdsZenohApi& zenoh_library() {
  static const RdsZenohApi& api = load();
  return api;
}

void ZenohFailure::refuse(const std::string& what) const {
  throw BusError("Zenoh refused " + what + ": " + text_);
}

const char* users_settings() {
  const char* file = std::getenv("ZENOH_CONFIG");
  return file == nullptr || *file == '\0' ? nullptr : file;
}

ZenohSession open_zenoh(const std::string& settings, const char* over) {
  const BlockedPipeSignal for_its_threads;
  ZenohFailure failure;
  return ZenohSession(failure.check(
      zenoh_library().open(settings.c_str(), over, failure.text(), ZenohFailure::kCapacity), "a session"));
}

ZenohPublisher declare_publisher(const ZenohSession& session, const std::string& key,
                                 const RdsZenohPublisherOptions& options) {
  ZenohFailure failure;
  return ZenohPublisher(
      failure.check(zenoh_library().declare_publisher(session.get(), key.c_str(), &options, failure.text(),
                                                      ZenohFailure::kCapacity),
                    "a publisher on " + key));
}

ZenohToken declare_token(const ZenohSession& session, const std::string& key) {
  ZenohFailure failure;
  return ZenohToken(failure.check(
      zenoh_library().declare_token(session.get(), key.c_str(), failure.text(), ZenohFailure::kCapacity),
      "the token " + key));
}

}  // namespace rds::bus::detail
