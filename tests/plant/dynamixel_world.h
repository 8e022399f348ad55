// A model that is driven through servos.
#pragma once

#include "plant/dynamixel/emulator/servo_world.h"

namespace kadans::test {

using DynamixelWorld = dynamixel::ServoWorld;

}  // namespace kadans::test
