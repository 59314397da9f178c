// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/session.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "services/viewer/listen_address.hpp"
#include "tools/rds/play/sensor_choice.hpp"
#include "tools/rds/run/results/results.hpp"
#include "tools/rds/run/services/join_bus.hpp"
#include "tools/rds/run/services/service_commands.hpp"
#include "tools/rds/topology/topology.hpp"

namespace rds::run {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

constexpr seconds kConnectLimit{30};
constexpr milliseconds kStatusLimit{300};
constexpr seconds kAcknowledgeLimit{120};  // in lockstep a frame waits for the adjustment of a large map, too
constexpr std::uint64_t kMapperBacklog = 10;  // keyframes; its inbox and the topic's history hold 20
constexpr seconds kFinishLimit{120};
const std::string kMapName = "map";
const std::string kPartsFolder = kMapsFolder + "/.saving";  // of the map, until all are there

/// A plain name is one beside the results.
std::unique_ptr<RunRecord> make_record(const RunOptions& options, int domain,
                                       const std::filesystem::path& results) {
  const std::filesystem::path named = options.record;
  if (named.empty()) return nullptr;
  return std::make_unique<RunRecord>(options, domain, named.has_parent_path() ? named : results / named);
}

}  // namespace

Session::Session(const RunOptions& options, const image::Recording& dataset,
                 const std::optional<Elsewhere>& elsewhere)
    : options_(options),
      dataset_(dataset),
      folder_(options.out, options.force),
      domain_(options.domain),
      bus_(join_bus(options, domain_.domain())),
      recorder_(*bus_),
      commander_(*bus_),
      player_(*bus_, dataset,
              {.rate = options.rate,
               .start = options.start,
               .frames = options.frames,
               .loop = false,
               .sensors = play::chosen_sensors(dataset, options.sensors)}),
      services_(options, domain_.domain(), folder_.path(), *bus_, elsewhere),
      overlay_(
          std::make_unique<OverlayWriter>(*bus_, recorder_, folder_.path(), options.video, dataset.fps())),
      record_(make_record(options, domain_.domain(), folder_.path())),
      progress_(player_.frame_count()) {}

int Session::run(const std::stop_token& stop) {
  services_.begin_elsewhere(stop);
  wait_until_connected(stop);
  if (!options_.view.empty())
    fmt::print(stderr, "the page: {}\n", viewer::parse_listen_address(options_.view).value().url());
  progress_.start();
  play::PlayerReport report;
  Answers answers;
  if (!stop.stop_requested()) report = play(stop);
  if (!stop.stop_requested()) answers = drain(stop);
  Recording recording =
      recorder_.recording();  // what is said after the services have left is nobody's of the run
  const auto usage = services_.stop(stop);
  overlay_->finish();
  if (record_) {
    const std::string fault = record_->finish();
    expect(fault.empty(), fault, stop);
  }
  if (stop.stop_requested()) {
    fmt::print(stderr, "stopped after {} frames, nothing is written\n", progress_.played());
    return 1;
  }
  write_results(std::move(recording), report, answers, usage);
  if (options_.view_keep) {
    fmt::print(stderr, "the results are written; the page stays until Ctrl-C\n");
    services_.keep_viewer(stop);
  }
  const auto failed = [](const auto& entry) { return !entry.second.failures.empty(); };
  return complete_ && std::ranges::none_of(usage, failed) ? 0 : 1;
}

void Session::wait_until_connected(const std::stop_token& stop) {
  std::set<std::string> running = services_.names();
  const std::size_t services = running.size();
  running.insert(kPlayer);
  const auto deadline = Clock::now() + kConnectLimit;
  std::vector<std::string> missing;
  while (!stop.stop_requested()) {
    services_.watch();
    const auto statuses = commander_.ask_status(services, stop, kStatusLimit);
    const Endpoints endpoints = endpoints_of(*bus_, statuses);
    missing = missing_links(running, endpoints, options_.localize_only, services_.elsewhere());
    if (missing.empty()) return record_ ? wait_until_recorded(endpoints, stop) : void();
    if (Clock::now() > deadline)
      throw std::runtime_error(fmt::format("the services did not connect within {} s: {}",
                                           kConnectLimit.count(), fmt::join(missing, "; ")));
  }
}

/// Volatile samples that are written before both ends know each other would be missing in the record.
void Session::wait_until_recorded(const Endpoints& before, const std::stop_token& stop) {
  const std::size_t services = services_.names().size();
  const auto deadline = Clock::now() + kConnectLimit;
  while (!stop.stop_requested()) {
    services_.watch();
    record_->look();
    if (record_->is_heard(before, endpoints_of(*bus_, commander_.ask_status(services, stop, kStatusLimit))))
      return;
    if (Clock::now() > deadline)
      throw std::runtime_error(fmt::format("--record: not all of the services' topics were found within {} s",
                                           kConnectLimit.count()));
  }
}

play::PlayerReport Session::play(const std::stop_token& stop) {
  play::PlayerReport report = player_.run(stop, [&](const image::RgbdFrame& frame, std::size_t index) {
    return after_frame(frame, index, stop);
  });
  if (report.played == 0 && report.unreadable > 0)
    throw std::runtime_error(fmt::format("no frame can be read: {}", report.first_error));
  if (report.unreadable > 0)
    fmt::print(stderr, "{} frames could not be read and were skipped: {}\n", report.unreadable,
               report.first_error);
  return report;
}

bool Session::after_frame(const image::RgbdFrame& frame, std::size_t index, const std::stop_token& stop) {
  overlay_->add_picture(index, frame);
  if (options_.lockstep()) {
    expect(recorder_.wait_acknowledged(frame.stamp_ns, stop, kAcknowledgeLimit),
           fmt::format("frame {}: not answered within {} s", index, kAcknowledgeLimit.count()), stop);
    if (services_.alive(kMapper) && !options_.localize_only)
      recorder_.wait_mapper(kMapperBacklog, stop, kAcknowledgeLimit);
  }
  services_.watch();
  progress_.add_frame(recorder_.keyframes());
  return true;
}

/// Ends the pipeline in the order in which data flow through it; each service answers when it has nothing
/// left to do.
Session::Answers Session::drain(const std::stop_token& stop) {
  Answers answers;
  const Recording so_far = recorder_.recording();
  if (!so_far.frames.empty())
    recorder_.wait_acknowledged(so_far.frames.rbegin()->first, stop, kAcknowledgeLimit);
  const std::string final_poses = ask(kTracker, "finish", "", stop);
  const auto json = nlohmann::json::parse(final_poses, nullptr, false);
  if (json.is_object()) {
    const auto revision = json.value("poses_revision", std::uint64_t{0});
    expect(recorder_.wait_poses(revision, stop, kAcknowledgeLimit),
           fmt::format("the final keyframe poses (revision {}) did not arrive within {} s", revision,
                       kAcknowledgeLimit.count()),
           stop);
    answers.keyframes_in_map = json.value("keyframes_in_map", std::uint64_t{0});
  }
  answers.map_description = ask(kMapper, "finish", final_poses, stop);
  save_map(stop);
  answers.status = commander_.ask_status(services_.names().size(), stop, seconds(2));
  answers.status.erase(kViewer);  // who looks on is no part of the results
  return answers;
}

/// Every service that has a part of the map writes it; together they are map.rds. The tracker is here, and
/// last: then the parts of other machines are here, too.
void Session::save_map(const std::stop_token& stop) {
  nlohmann::json order{{"name", kMapName}, {"id", "run"}, {"parts", nlohmann::json::array()}};
  std::vector<std::string> services;
  for (const std::string& service : {kMapper, kLoopCloser, kTracker})
    if (services_.alive(service)) services.push_back(service);
  for (const std::string& service : services) order["parts"].push_back(part_of(service));
  for (const std::string& service : services) {
    if (service == kTracker) services_.fetch(kPartsFolder, stop);
    ask(service, "save", order.dump(), stop);
  }
  if (!stop.stop_requested()) take_map_files();
}

/// From the services' folder of maps into that of the results.
void Session::take_map_files() {
  const auto saved = folder_.path() / kMapsFolder / kMapName;
  if (!std::filesystem::exists(saved)) return;  // a service has not saved its part, and that was said
  for (const auto& file : std::filesystem::directory_iterator(saved))
    std::filesystem::rename(file.path(), folder_.path() / file.path().filename());
}

/// What does not hold is said, and the run is not complete; of a run that is stopped nothing is expected.
void Session::expect(bool holds, const std::string& otherwise, const std::stop_token& stop) {
  if (holds || stop.stop_requested()) return;
  complete_ = false;
  fmt::print(stderr, "{}\n", otherwise);
}

/// @return the answer; empty, and the run is not complete, if the command failed.
std::string Session::ask(const std::string& service, const std::string& verb, const std::string& argument,
                         const std::stop_token& stop) {
  services_.watch();
  const auto reply = commander_.ask(service, verb, argument, stop, kFinishLimit);
  if (reply && reply->success) return reply->message;
  expect(false, fmt::format("{} {}: {}", service, verb, reply ? reply->message : "no answer"), stop);
  return {};
}

void Session::write_results(Recording recording, const play::PlayerReport& report, const Answers& answers,
                            const std::map<std::string, ServiceUsage>& usage) {
  const double wall_s = progress_.elapsed_s();
  recording.keyframes_in_map = answers.keyframes_in_map;
  write_all_results({options_,
                     recording,
                     report,
                     usage,
                     answers.status,
                     player_.frame_count(),
                     wall_s,
                     answers.map_description,
                     {},
                     {}},
                    dataset_, folder_.path());
  std::filesystem::remove_all(folder_.path() / kMapsFolder);
  folder_.publish();
}

}  // namespace rds::run
