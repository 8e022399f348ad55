// A type of plant "bench", which the robot's configuration sets under plant.bench.
#pragma once

#include <memory>

#include "kadans/plant/plant_type.h"

std::unique_ptr<kadans::PlantType> make_bench_type();
