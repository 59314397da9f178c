// SPDX-License-Identifier: Apache-2.0
#include "common/service/service_process.hpp"

#include <algorithm>
#include <csignal>
#include <optional>

#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include "common/service/process/stop_signals.hpp"

namespace rds::service {
namespace {

constexpr std::size_t kMaxEvents = 64;
constexpr timespec kSignalPoll{.tv_sec = 0, .tv_nsec = 100'000'000};
constexpr std::chrono::milliseconds kRoleCheck{1000};  // a peer that went without a word makes no event

constexpr std::chrono::seconds kStopLimit{20};  // for a worker to end

}  // namespace

ServiceProcess::ServiceProcess(ServiceContext& context, Settings& settings, ProcessOptions options)
    : context_(context),
      settings_(settings),
      options_(std::move(options)),
      events_(mailbox_, kMaxEvents),
      presence_(context, [this] { events_.push(Event::kPeersChanged); }),
      publisher_(context, presence_, service_),
      hang_watch_(options_.exit_when_hung_s) {}

int ServiceProcess::run() {
  activate();
  commands_.emplace(context_, presence_, service_);
  sd_notify(0, "READY=1");  // where nobody supervises the process, nothing happens
  std::jthread watcher([this](const std::stop_token& stop) { watch(stop); });
  while (true) {
    mailbox_.wait_for({}, kRoleCheck, [this] { return !events_.locked_empty(); });
    const auto event = events_.try_pop();
    if (event == Event::kSignal || event == Event::kWorkerEnded) break;
    change_role();
  }
  sd_notify(0, "STOPPING=1");
  stand_by();
  publisher_.finish();
  presence_.say_goodbye();
  return failed_ ? 1 : 0;
}

void ServiceProcess::end_if_hung(double since_last_look_s) {
  const double silent_s = std::max(service_.worker_state().silent_s, publisher_.silent_s());
  if (!hang_watch_.look(silent_s, since_last_look_s)) return;
  spdlog::critical("ended: nothing has been heard of the worker for {:.0f} s", silent_s);
  _exit(1);
}

void ServiceProcess::end_if_deaf(double since_last_look_s) {
  if (!deafness_watch_.look(presence_.peers().hears_another_than(context_.instance), since_last_look_s))
    return;
  spdlog::critical(
      "ended: it was stopped for a while, and has heard of no other service since; to be started again");
  _exit(1);
}

void ServiceProcess::watch(const std::stop_token& stop) {
  const sigset_t signals = stop_signals();
  std::optional<std::chrono::steady_clock::time_point> stopping_since;
  auto last_look = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    const int received = sigtimedwait(&signals, nullptr, &kSignalPoll);
    if (received > 0 && stopping_since) {
      spdlog::warn("stopped at once, by a second signal");
      _exit(128 + received);
    }
    const auto now = std::chrono::steady_clock::now();
    const double since_last_look_s = std::chrono::duration<double>(now - last_look).count();
    end_if_hung(since_last_look_s);
    end_if_deaf(since_last_look_s);
    last_look = now;
    if (received > 0) {
      stopping_since = now;
      request_stop();
    } else if (stopping_since && now - *stopping_since > kStopLimit) {
      spdlog::critical("stopped although the worker still hangs");
      _exit(1);
    }
  }
}

void ServiceProcess::activate() {
  auto made = settings_.configured().make(context_);
  Service& service = *made;
  service.when_set([this, &service](const std::string& changes) {
    const auto set = settings_.set(changes, service);
    return set ? CommandOutcome{true, "set"} : CommandOutcome{false, set.error()};
  });
  service_.put(std::move(made));
  presence_.set_active(true);
  if (offers_services(context_.participant)) offer_services(service);
  worker_ = std::jthread([this, &service](const std::stop_token& stop) { work(stop, service); });
}

void ServiceProcess::offer_services(Service& service) {
  command_services_.emplace(context_, service_);
  const auto post = [this](const std::string& verb, std::function<void(bool)> respond) {
    return service_.post(
               {.verb = verb, .argument = "", .answer = [respond = std::move(respond)](const auto& outcome) {
                  respond(outcome.success);
                }}) == Posted::kQueued;
  };
  lifecycle_services_.emplace(
      context_.bus, post, [] { kill(getpid(), SIGTERM); }, options_.managed ? kUnconfigured : kActive);
  service.when_paused(lifecycle_services_->when_paused());
  if (options_.parameters) offer_parameters();
  if (!options_.managed) return;
  post("pause", [](bool) {});  // until it is activated
  bond_.emplace(context_.bus, context_.participant.node_name, context_.instance, [this] {
    return lifecycle_services_->is_active() && service_.worker_state().silent_s < Bond::kHeartbeatTimeoutS;
  });
}

void ServiceProcess::offer_parameters() {
  const auto set = [this](const std::string& changes, ParameterServices::Answered answered) {
    service_.command({.verb = "set", .argument = changes, .answer = [answered](const auto& outcome) {
                        answered(outcome.success, outcome.message);
                      }});
  };
  parameter_services_.emplace(context_.bus, options_.parameters(), full_node_name(context_), set);
  settings_.when_set([this](const auto& values) { parameter_services_->take(values); });
}

void ServiceProcess::work(const std::stop_token& stop, Service& service) {
  try {
    service.run(stop);
    service.close();
  } catch (const std::exception& e) {
    spdlog::critical("stopped: {}", e.what());
    failed_ = true;
  }
  if (!stop.stop_requested()) events_.push(Event::kWorkerEnded);
}

/// Ends the worker, if there is one, and its service.
void ServiceProcess::stand_by() {
  worker_.request_stop();
  if (worker_.joinable()) worker_.join();
  const auto ended = service_.put(nullptr);
  bond_.reset();
  parameter_services_.reset();
  lifecycle_services_.reset();  // a node of the same name may be active now
  command_services_.reset();
  context_.diagnostics.forget_gauges();
  if (presence_.is_active()) presence_.set_active(false);
}

void ServiceProcess::change_role() {
  const bool active = presence_.should_be_active();
  if (active == presence_.is_active()) return;
  if (active) {
    spdlog::warn("nobody else is active any more, this one takes over");
    activate();
  } else {
    stand_by();
    spdlog::error("{}", presence_.rivalry().value_or("another one is active"));
  }
}

}  // namespace rds::service
