#include "kadans/plant/plant_type.h"

namespace kadans {
namespace {

class DynamixelType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "dynamixel"; }
  std::string_view doc() const noexcept override { return "Dynamixel servos on serial ports, protocol 2.0"; }
};

}  // namespace

std::unique_ptr<PlantType> make_dynamixel_type() { return std::make_unique<DynamixelType>(); }

}  // namespace kadans
