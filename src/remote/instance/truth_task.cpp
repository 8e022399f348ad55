#include "truth_task.h"

namespace kadans {

void TruthTask::beside_tick(std::int64_t time_ns) {
  truth_.update(1e-9 * static_cast<double>(time_ns), control_.row());
}

}  // namespace kadans
