// A model that is driven through HostMot2 boards.
#pragma once

#include "plant/hostmot2/emulator/board_world.h"

namespace kadans::test {

using HostMot2World = hostmot2::BoardWorld;

}  // namespace kadans::test
