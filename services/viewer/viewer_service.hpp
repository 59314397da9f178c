// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <set>
#include <string>

#include "common/service/service.hpp"
#include "services/viewer/command_port.hpp"
#include "services/viewer/core/board/board.hpp"
#include "services/viewer/core/board/page_client.hpp"
#include "services/viewer/foxglove_bridge.hpp"
#include "services/viewer/scene.hpp"
#include "services/viewer/server/web_server.hpp"
#include "services/viewer/viewer_service_config.hpp"

namespace rds::viewer {

/// Shows what is on the bus: a web page, clients of Foxglove's protocol, Prometheus. Reads the bus alone, but
/// for commands of pages, where they are allowed. The worker serves the sockets and owns all else.
class ViewerService final : public service::Service, private WebApp {
 public:
  /// @param token  that clients need; empty: none.
  /// @throws std::runtime_error where the port cannot be had.
  ViewerService(service::ServiceContext& context, const ViewerServiceConfig& config,
                const std::string& token);
  ~ViewerService() override;
  ViewerService(const ViewerService&) = delete;
  ViewerService& operator=(const ViewerService&) = delete;
  void run(const std::stop_token& stop) override;
  static constexpr std::array kLiveSettings{"picture_hz", "picture_quality"};
  /// Takes over what may change while it runs, on its worker.
  void reconfigure(const ViewerServiceConfig& config);

 protected:
  service::CommandOutcome execute(const std::string& verb, const std::string& argument) override;

 private:
  HttpAnswer get(const Request& request) override;
  Opening open(const Request& request) override;
  void close(Conversation& conversation) override;

  Opening open_page();
  void notify();
  void take();
  void count_clients();
  [[nodiscard]] std::string hello() const;

  ViewerServiceConfig config_;
  AccessRules rules_;
  Board board_;
  std::set<PageClient*> pages_;
  std::atomic<bool> is_told_ = false;          // take() is under way
  std::unique_ptr<CommandPort> command_port_;  // nullptr: commands are not allowed
  std::unique_ptr<FoxgloveBridge> foxglove_;
  std::unique_ptr<WebServer> server_;  // its sessions tell the two above when they end
  std::unique_ptr<Scene> scene_;
};

}  // namespace rds::viewer
