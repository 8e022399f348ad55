// How a plant on another machine is reached, and how long either side goes on without the other. Fields are keys of the
// robot's configuration, plant.udp.
#pragma once

#include <string>

namespace kadans {

struct UdpSettings {
  std::string peer;                // "host:port" of the plant; "": given on the command line
  double connect_timeout_s = 5;    // how long the control side waits for the plant's answer
  double round_trip_max_s = 0.01;  // readings that answer an actuation older than this are not new
  double watchdog_s = 0.02;        // without an actuation for this long the plant's side damps the joints
  double peer_timeout_s = 1;       // without an actuation for this long it ends the session
  double damping_Nms_per_rad = 2;  // of that watchdog; the robot's safety.damping_Nms_per_rad, no key of its own
};

}  // namespace kadans
