// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/map_services.hpp"

#include <stdexcept>
#include <utility>

#include "common/service/command_services.hpp"
#include "nav_msgs/srv/GetMap_Request.h"
#include "nav_msgs/srv/GetMap_Response.h"
#include "octomap_msgs/srv/GetOctomap_Request.h"
#include "octomap_msgs/srv/GetOctomap_Response.h"

namespace rds::mapper {

using nav_msgs::srv::GetMap_Request;
using nav_msgs::srv::GetMap_Response;
using octomap_msgs::srv::GetOctomap_Request;
using octomap_msgs::srv::GetOctomap_Response;

MapServices::MapServices(service::ServiceContext& context, concurrency::Mailbox& mailbox, MapOutputs& outputs)
    : outputs_(outputs), asked_(mailbox, kMaxWaiting) {
  if (!service::offers_services(context.participant)) return;
  services_.push_back(bus::serve_later<GetMap_Request, GetMap_Response>(
      context.bus, "~/map", [this](const auto& /*request*/, auto answer) {
        ask([this, answer = std::move(answer)](const SemanticMapper& mapper) {
          outputs_.make_grid_message(mapper, [answer](nav_msgs::msg::OccupancyGrid&& grid) {
            GetMap_Response response;
            response.map(std::move(grid));
            answer(response);
          });
        });
      }));
  services_.push_back(octomap(context.bus, "octomap_binary", true));
  services_.push_back(octomap(context.bus, "octomap_full", false));
}

bus::ServiceServer MapServices::octomap(bus::Participant& bus, const std::string& name, bool binary) {
  return bus::serve_later<GetOctomap_Request, GetOctomap_Response>(
      bus, name, [this, binary](const auto& /*request*/, auto answer) {
        ask([this, binary, answer = std::move(answer)](const SemanticMapper& mapper) {
          outputs_.make_octomap_message(mapper, binary, [answer](octomap_msgs::msg::Octomap&& map) {
            GetOctomap_Response response;
            response.map(std::move(map));
            answer(response);
          });
        });
      });
}

/// On a thread of a service.
void MapServices::ask(Asked asked) {
  if (!asked_.try_push(std::move(asked))) throw std::runtime_error("too many requests wait");
}

void MapServices::settle(const SemanticMapper& mapper) {
  if (outputs_.is_busy()) return;
  if (const auto asked = asked_.try_pop()) (*asked)(mapper);
}

}  // namespace rds::mapper
