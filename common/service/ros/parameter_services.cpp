// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/parameter_services.hpp"

#include <stdexcept>
#include <utility>

#include "rcl_interfaces/srv/DescribeParameters_Request.h"
#include "rcl_interfaces/srv/DescribeParameters_Response.h"
#include "rcl_interfaces/srv/GetParameterTypes_Request.h"
#include "rcl_interfaces/srv/GetParameterTypes_Response.h"
#include "rcl_interfaces/srv/GetParameters_Request.h"
#include "rcl_interfaces/srv/GetParameters_Response.h"
#include "rcl_interfaces/srv/ListParameters_Request.h"
#include "rcl_interfaces/srv/ListParameters_Response.h"
#include "rcl_interfaces/srv/SetParametersAtomically_Request.h"
#include "rcl_interfaces/srv/SetParametersAtomically_Response.h"
#include "rcl_interfaces/srv/SetParameters_Request.h"
#include "rcl_interfaces/srv/SetParameters_Response.h"

namespace rds::service {
namespace {

using namespace rcl_interfaces::srv;

/// An answer may be fifty times as large as the question: a few times what any node has.
constexpr std::size_t kMostNames = 1000;

template <class Sequence>
const Sequence& checked(const Sequence& asked) {
  if (asked.size() > kMostNames) throw std::invalid_argument("too many names");
  return asked;
}

}  // namespace

ParameterServices::ParameterServices(bus::Participant& bus, ParameterTable table) : table_(std::move(table)) {
  services_.push_back(bus::serve<ListParameters_Request, ListParameters_Response>(
      bus, "~/list_parameters", [this](const ListParameters_Request& request) {
        ListParameters_Response response;
        response.result(table_.list(checked(request.prefixes()), request.depth()));
        return response;
      }));
  services_.push_back(bus::serve<GetParameters_Request, GetParameters_Response>(
      bus, "~/get_parameters", [this](const GetParameters_Request& request) {
        GetParameters_Response response;
        response.values(table_.values(checked(request.names())));
        return response;
      }));
  services_.push_back(bus::serve<GetParameterTypes_Request, GetParameterTypes_Response>(
      bus, "~/get_parameter_types", [this](const GetParameterTypes_Request& request) {
        GetParameterTypes_Response response;
        response.types(table_.kinds(checked(request.names())));
        return response;
      }));
  services_.push_back(bus::serve<DescribeParameters_Request, DescribeParameters_Response>(
      bus, "~/describe_parameters", [this](const DescribeParameters_Request& request) {
        DescribeParameters_Response response;
        response.descriptors(table_.descriptors(checked(request.names())));
        return response;
      }));
  services_.push_back(bus::serve<SetParameters_Request, SetParameters_Response>(
      bus, "~/set_parameters", [this](const SetParameters_Request& request) {
        SetParameters_Response response;
        for (const auto& parameter : checked(request.parameters()))
          response.results().push_back(table_.refuse(parameter.name()));
        return response;
      }));
  services_.push_back(bus::serve<SetParametersAtomically_Request, SetParametersAtomically_Response>(
      bus, "~/set_parameters_atomically", [this](const SetParametersAtomically_Request& request) {
        SetParametersAtomically_Response response;
        if (request.parameters().empty())
          response.result().successful(true);
        else
          response.result(table_.refuse(request.parameters().front().name()));
        return response;
      }));
}

}  // namespace rds::service
