// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rds::service {

// What systemd is told of a unit with Type=notify (sd_notify(3)). Where nobody supervises the process, nothing
// happens. Safe to use from any thread.

/// The service works, or waits as stand-by.
void tell_supervisor_ready();
/// It is alive: to be said more often than twice in WatchdogSec.
void tell_supervisor_alive();
/// It has begun to stop.
void tell_supervisor_stopping();
/// How it is, one line for people.
void tell_supervisor_status(const std::string& status);

}  // namespace rds::service
