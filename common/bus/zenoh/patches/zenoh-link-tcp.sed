# SPDX-License-Identifier: Apache-2.0
# 17 lines of zenoh-link-tcp 1.10.2: closing does not wait.
/\/\/ Set the TCP linger option/,/^        }$/d
/static ref TCP_LINGER_TIMEOUT/d
s/ convert::TryInto,//
s/, TCP_LINGER_TIMEOUT//
