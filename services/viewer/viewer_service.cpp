// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/viewer_service.hpp"

#include <algorithm>
#include <chrono>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "services/viewer/listen_address.hpp"
#include "services/viewer/page/page_files.hpp"

namespace rds::viewer {
namespace {

/// Commands to this service wait so long; all else wakes the worker.
constexpr std::chrono::milliseconds kServe{100};
constexpr double kServicesPeriodS = 1;
constexpr const char* kSocketPath = "/socket";
constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

HttpAnswer refused(unsigned status, const char* reason) {
  return {.status = status, .text = std::string(reason) + "\n"};
}

}  // namespace

ViewerService::ViewerService(service::ServiceContext& context, const ViewerServiceConfig& config,
                             const std::string& token)
    : Service(context), config_(config) {
  const ListenAddress listen = parse_listen_address(config.listen).value();
  rules_ = {listen.is_loopback(), token, config.allowed_origins};
  const auto notified = [this] { notify(); };
  server_ = std::make_unique<WebServer>(listen.address, listen.port,
                                        ServerLimits{.clients = static_cast<std::size_t>(config.max_clients)},
                                        static_cast<WebApp&>(*this));
  if (config.allow_commands) command_port_ = std::make_unique<CommandPort>(context, notified);
  foxglove_ = std::make_unique<FoxgloveBridge>(context, config, notified);
  scene_ = std::make_unique<Scene>(context, config, board_, notified);
  board_.put(Kind::kHello, text_frame(Kind::kHello, hello()));
  spdlog::info("the page is at {}{}", ListenAddress{listen.address, server_->port()}.url(),
               token.empty() ? "" : "?token=…");
}

/// Bus threads end before the server that they tell, and that before those whom its sessions tell.
ViewerService::~ViewerService() {
  scene_.reset();
  command_port_.reset();
  foxglove_->stop_listening();
  server_.reset();
}

void ViewerService::reconfigure(const ViewerServiceConfig& config) {
  scene_->set_picture(config.picture_hz, config.picture_quality);
}

void ViewerService::run(const std::stop_token& stop) {
  for (double services_put_s = 0; !stop.stop_requested();) {
    beat();
    server_->serve_for(kServe);
    handle_commands();
    if (now_s() - services_put_s < kServicesPeriodS) continue;
    services_put_s = now_s();
    scene_->put_services(services_put_s);
    count_clients();
    server_->pump();
  }
}

/// From any thread; what comes while the worker has not begun to look is one look.
void ViewerService::notify() {
  if (!is_told_.exchange(true)) server_->post([this] { take(); });
}

void ViewerService::take() {
  is_told_ = false;
  guarded("the bus", [this] {
    scene_->take();
    foxglove_->take();
    if (command_port_) command_port_->take();
  });
  server_->pump();
}

void ViewerService::count_clients() {
  const auto& counts = server_->counts();
  context_.diagnostics.counter("connections") = counts.connections;
  context_.diagnostics.counter("connections refused") = counts.refused;
  context_.diagnostics.counter("connections closed, malformed") = counts.malformed;
  context_.diagnostics.counter("client messages refused") = counts.refused_messages;
  context_.diagnostics.counter("clients") = counts.clients;
  scene_->want_picture(std::ranges::any_of(pages_, &PageClient::wants_picture));
}

HttpAnswer ViewerService::get(const Request& request) {
  const auto target = parse_target(request.target);
  if (!target) return refused(400, "no such address");
  if (!is_own_host(request.host, rules_)) return refused(403, "expected the address of this machine in Host");
  if (target->path == "/metrics") {
    if (!has_token(request, *target, rules_)) return refused(401, "expected the token");
    return {.content_type = kMetricsType, .text = scene_->metrics(now_s(), server_->counts().clients)};
  }
  const auto file = find_page_file(target->path);
  if (!file) return refused(404, "no such file");
  return {.content_type = file->content_type, .file = file->bytes};
}

Opening ViewerService::open(const Request& request) {
  const auto target = parse_target(request.target);
  if (!target || !is_own_host(request.host, rules_) || !is_allowed_origin(request, rules_))
    return {nullptr, {}, refused(403, "not from this page (setting allowed_origins)")};
  if (!has_token(request, *target, rules_)) return {nullptr, {}, refused(401, "expected the token")};
  if (target->path == kSocketPath && !choose_protocol(request.protocols, {kPageProtocol}).empty())
    return open_page();
  const std::string protocol = choose_protocol(request.protocols, foxglove::kProtocols);
  if (protocol.empty()) return {nullptr, {}, refused(400, "no such protocol")};
  try {
    return {foxglove_->open(), protocol, {}};
  } catch (const bus::BusError& e) {
    spdlog::warn("the bus cannot be joined for a client: {}", e.what());
    return {nullptr, {}, refused(503, "the bus cannot be joined")};
  }
}

Opening ViewerService::open_page() {
  auto page = std::make_unique<PageClient>(board_);
  if (command_port_)
    page->allow([this, raw = page.get()](const PageCommand& command) { command_port_->send(*raw, command); });
  pages_.insert(page.get());
  return {std::move(page), kPageProtocol, {}};
}

void ViewerService::close(Conversation& conversation) {
  if (auto* page = dynamic_cast<PageClient*>(&conversation)) {
    pages_.erase(page);
    if (command_port_) command_port_->forget(*page);
  } else if (auto* client = dynamic_cast<foxglove::FoxgloveClient*>(&conversation)) {
    foxglove_->close(*client);
  }
}

std::string ViewerService::hello() const {
  return nlohmann::json{
      {"version", RDS_VERSION}, {"domain", context_.domain}, {"commands", config_.allow_commands}}
      .dump();
}

service::CommandOutcome ViewerService::execute(const std::string& verb, const std::string& /*argument*/) {
  if (verb != "reset") return unknown_command(verb);
  scene_->forget_path();
  return {true, "forgot the path"};
}

}  // namespace rds::viewer
