// SPDX-License-Identifier: Apache-2.0
#include "common/service/process/supervisor.hpp"

#include <systemd/sd-daemon.h>

#include "common/service/process/printable.hpp"

namespace rds::service {

void tell_supervisor_ready() {
  sd_notify(0, "READY=1");
}

void tell_supervisor_alive() {
  sd_notify(0, "WATCHDOG=1");
}

void tell_supervisor_stopping() {
  sd_notify(0, "STOPPING=1");
}

void tell_supervisor_status(const std::string& status) {
  sd_notify(0, ("STATUS=" + printable(status)).c_str());
}

}  // namespace rds::service
