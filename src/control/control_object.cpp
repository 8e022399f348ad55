#include "kadans/control/control_object.h"

#include <utility>

namespace kadans {

ParameterId Declaration::parameter(Parameter parameter, double* value) {
  parameter.name = object_ + "." + parameter.name;
  return parameters_.add(std::move(parameter), value, owner_);
}

SetpointId Declaration::setpoint(Setpoint setpoint) {
  setpoint.name = object_ + "." + setpoint.name;
  setpoint.owner = owner_;
  return setpoints_.add(std::move(setpoint));
}

}  // namespace kadans
