// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "common/bus/domain_lock.hpp"
#include "common/commander/commander.hpp"
#include "common/image/recording.hpp"
#include "tools/rds/play/player.hpp"
#include "tools/rds/run/output/output_folder.hpp"
#include "tools/rds/run/progress.hpp"
#include "tools/rds/run/results/overlay_writer.hpp"
#include "tools/rds/run/results/recorder.hpp"
#include "tools/rds/run/run_record.hpp"
#include "tools/rds/run/run_services.hpp"

namespace rds::run {

/// One `rds run`: starts the services, plays the recording, waits until everything has drained, writes the
/// results.
class Session {
 public:
  /// @throws std::runtime_error with one sentence when the run cannot start.
  Session(const RunOptions& options, const image::Recording& dataset,
          const std::optional<Elsewhere>& elsewhere = {});

  /// @return the process's exit status: 0 if every service stayed healthy, 1 otherwise.
  int run(const std::stop_token& stop);

 private:
  /// What the services answered when all frames were played.
  struct Answers {
    std::map<std::string, std::string> status;
    std::string map_description;
    std::uint64_t keyframes_in_map = 0;
  };
  void wait_until_connected(const std::stop_token& stop);
  void wait_until_recorded(const Endpoints& before, const std::stop_token& stop);
  play::PlayerReport play(const std::stop_token& stop);
  bool after_frame(const image::RgbdFrame& frame, std::size_t index, const std::stop_token& stop);
  Answers drain(const std::stop_token& stop);
  void save_map(const std::stop_token& stop);
  void take_map_files();
  void expect(bool holds, const std::string& otherwise, const std::stop_token& stop);
  std::string ask(const std::string& service, const std::string& verb, const std::string& argument,
                  const std::stop_token& stop);
  void write_results(Recording recording, const play::PlayerReport& report, const Answers& answers,
                     const std::map<std::string, ServiceUsage>& usage);

  const RunOptions& options_;
  const image::Recording& dataset_;
  OutputFolder folder_;
  bus::DomainLock domain_;
  std::unique_ptr<bus::Participant> bus_;
  Recorder recorder_;
  commander::Commander commander_;
  play::Player player_;
  RunServices services_;
  std::unique_ptr<OverlayWriter> overlay_;
  std::unique_ptr<RunRecord> record_;  // none: nothing is to be kept
  Progress progress_;
  bool complete_ = true;  // nothing timed out
};

}  // namespace rds::run
