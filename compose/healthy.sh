#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# healthy.sh SERVICE: exit status 0 if the service's figures, which it publishes once a second, arrive on the bus.
timeout 18 rds topic echo diagnostics --bus "${RDS_BUS:-fastdds}" --timeout 15 --count 40 2>/dev/null |
  grep -q -m 1 -E "\"name\": ?\"$1\""
