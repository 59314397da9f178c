// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/live_map_save.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "common/map_file/saved_map.hpp"
#include "tools/rds/run/commander.hpp"
#include "tools/rds/run/topology.hpp"

namespace rds::tools {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kStatusTime{300};
constexpr std::chrono::seconds kSaveTime{60};

/// A folder that disappears with the object.
class PartsFolder {
 public:
  explicit PartsFolder(const fs::path& beside) : path_(fs::absolute(beside)) {
    path_ += fmt::format(".parts-{}", getpid());
    std::error_code error;
    fs::create_directories(path_, error);
    fs::permissions(path_, fs::perms::all, error);  // the services may run as another user
  }
  ~PartsFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PartsFolder(const PartsFolder&) = delete;
  PartsFolder& operator=(const PartsFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// The services with a part of the map that answer before the deadline; all three end the wait.
std::vector<std::string> wait_for_services(run::Commander& commander, Clock::time_point deadline,
                                           const std::stop_token& stop) {
  std::vector<std::string> there;
  while (there.size() < 3 && Clock::now() < deadline && !stop.stop_requested()) {
    there.clear();
    const auto answers = commander.ask_status(5, stop, kStatusTime);
    for (const std::string& name : {run::kTracker, run::kMapper, run::kLoopCloser})
      if (answers.contains(name)) there.push_back(name);
  }
  return there;
}

}  // namespace

tl::expected<void, std::string> save_live_map(bus::Participant& participant, const fs::path& file,
                                              std::chrono::duration<double> timeout,
                                              const std::stop_token& stop) {
  run::Commander commander(participant);
  const auto services =
      wait_for_services(commander, Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout), stop);
  for (const std::string& needed : {run::kTracker, run::kMapper})
    if (std::ranges::find(services, needed) == services.end())
      return tl::unexpected(fmt::format("{} does not answer, expected it to be running", needed));
  const PartsFolder parts(file);
  for (const std::string& service : services) {
    const auto reply = commander.ask(service, "save", parts.path().string(), stop, kSaveTime);
    if (!reply)
      return tl::unexpected(fmt::format("{}: no answer to 'save' in {} s", service, kSaveTime.count()));
    if (!reply->success) return tl::unexpected(fmt::format("{}: {}", service, reply->message));
  }
  return map_file::merge_service_files(parts.path(), file);
}

}  // namespace rds::tools
