// The world model as it is seen from where the robot is in a tick.
#pragma once

#include <cstdint>
#include <vector>

#include "kadans/signal/seen_info.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/status.h"

namespace kadans {

// `kept`: with places along the path of the odometry, as the supervisor published it. Control thread; bounded.
void show_seen(const SeenEntries& kept, const OdometryStatus& odometry, std::int64_t time_ns,
               SeenEntries& shown) noexcept;

// Declares seen.NAME.FIELD of the entries that are shown. Before the loop.
void declare_seen(SignalTable& table, const std::vector<SeenInfo>& declared, const SeenEntries& shown);

}  // namespace kadans
