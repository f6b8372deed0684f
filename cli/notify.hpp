#pragma once

#include <string_view>

namespace sluice {

/// Tells the service manager a state, such as "READY=1": the protocol of sd_notify(3), one datagram
/// to the socket that NOTIFY_SOCKET names. Does nothing where there is none.
void notify_manager(std::string_view state);

}  // namespace sluice
