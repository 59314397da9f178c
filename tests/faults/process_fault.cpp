// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/process_fault.hpp"

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>

#include <unistd.h>

#include "tests/integration/run_support.hpp"
#include "tools/rds/run/services/service_commands.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;

constexpr double kSecondKillShare = 0.4;  // of the fault's time
constexpr double kStarvedPeriodS = 0.2;
constexpr double kStarvedShare = 0.75;
constexpr double kSaveShare = 0.2;
constexpr auto kSaveLimit = 90s;  // a service gives up after 60 s

bool is_of_disk(Fault fault) {
  return fault == Fault::kDiskFull || fault == Fault::kDiskError;
}

}  // namespace

FailingDisk::FailingDisk(const Row& row, const std::filesystem::path& place) {
  if (!is_of_disk(row.fault)) return;
  armed_ = place / "failing_disk";
  setenv("FAILING_DISK_ARMED", armed_.c_str(), 1);
  setenv("FAILING_DISK_PROGRAM", row.service.c_str(), 1);
  setenv("FAILING_DISK_FOLDER", run::kMapsFolder.c_str(), 1);
  setenv("LD_PRELOAD", RDS_FAILING_DISK, 1);
}

FailingDisk::~FailingDisk() {
  if (!armed_.empty()) unsetenv("LD_PRELOAD");
}

void FailingDisk::arm(Fault fault) {
  write_text(armed_.string() + ".new", std::to_string(fault == Fault::kDiskFull ? ENOSPC : EIO));
  std::filesystem::rename(armed_.string() + ".new", armed_);
}

void FailingDisk::disarm() {
  std::filesystem::remove(armed_);
}

ProcessFault::ProcessFault(const Row& row, const Timing& timing, run::ServiceCommand command,
                           commander::Commander& commander, FailingDisk& disk)
    : row_(row), timing_(timing), command_(std::move(command)), commander_(commander), disk_(disk) {}

void ProcessFault::act(double at_s) {
  if (row_.service.empty()) return;
  if (phase_ == Phase::kBefore && at_s >= timing_.at_s) {
    phase_ = Phase::kDuring;
    begin();
  }
  if (phase_ == Phase::kDuring) go_on(at_s - timing_.at_s);
  if (phase_ == Phase::kDuring && at_s >= timing_.at_s + timing_.lasts_s) {
    phase_ = Phase::kAfter;
    end();
  }
}

void ProcessFault::send(int signal) {
  const auto found = children(getpid(), row_.service);
  if (found.size() != 1 || kill(found.front(), signal) != 0) missed_ = row_.service + " was not there";
}

void ProcessFault::begin() {
  switch (row_.fault) {
    case Fault::kKill:
    case Fault::kKillTwice:
      return send(SIGKILL);
    case Fault::kStop:
      return send(SIGSTOP);
    case Fault::kRestart:
      return send(SIGTERM);
    case Fault::kTwin:
      twin_.emplace(command_.command, command_.log);
      return;
    case Fault::kDiskFull:
    case Fault::kDiskError:
      return disk_.arm(row_.fault);
    default:
      return;
  }
}

void ProcessFault::go_on(double since_begin_s) {
  if (row_.fault == Fault::kKillTwice && !killed_again_ &&
      since_begin_s >= kSecondKillShare * timing_.lasts_s) {
    killed_again_ = true;
    send(SIGKILL);
  }
  if (is_of_disk(row_.fault) && !saved_.valid() && since_begin_s >= kSaveShare * timing_.lasts_s)
    try_to_save();
  if (row_.fault != Fault::kStarve) return;
  const bool stops =
      std::fmod(since_begin_s / timing_.rate, kStarvedPeriodS) < kStarvedShare * kStarvedPeriodS;
  if (stops != is_stopped_) send(stops ? SIGSTOP : SIGCONT);
  is_stopped_ = stops;
}

void ProcessFault::end() {
  if (row_.fault == Fault::kStop || is_stopped_) send(SIGCONT);
  if (twin_ && twin_->poll()) missed_ = "the second " + row_.service + " ended by itself";
  if (twin_) twin_->ask_to_stop();
  if (is_of_disk(row_.fault)) disk_.disarm();
}

/// Beside the frames, which wait for nobody.
void ProcessFault::try_to_save() {
  saved_ = std::async(std::launch::async, [this] {
    return commander_.ask(row_.service, "save", "to_a_failing_disk", {}, kSaveLimit);
  });
}

std::string ProcessFault::verdict() {
  if (!row_.service.empty() && phase_ != Phase::kAfter) return "the fault has not ended";
  if (!missed_.empty()) return missed_;
  if (twin_ && twin_->wait_or_kill(std::chrono::steady_clock::now() + 10s).status != 0)
    return "the second " + row_.service + " did not stop when it was asked to";
  if (!saved_.valid()) return "";
  const auto reply = saved_.get();
  if (!reply) return "save to a failing disk was not answered";
  return reply->success ? "save to a failing disk was answered: " + reply->message : "";
}

}  // namespace rds::test
