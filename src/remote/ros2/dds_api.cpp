#include "dds_api.h"

#include <dlfcn.h>

#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

template <typename Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr)
    throw InputError(InputProblem{.file = KADANS_DDS_LIBRARY, .message = std::string("has no ") + name});
}

DdsApi load() {
  void* const library = dlopen(KADANS_DDS_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw InputError(InputProblem{.file = "--ros2",
                                  .message = std::string("needs Cyclone DDS (apt-get install libddsc0debian): ") +
                                             dlerror()});  // NOLINT(concurrency-mt-unsafe): before any thread
  DdsApi api{};
#define KADANS_FIND(name) find(library, #name, api.name)
  KADANS_FIND(dds_create_domain);
  KADANS_FIND(dds_create_participant);
  KADANS_FIND(dds_create_topic);
  KADANS_FIND(dds_create_writer);
  KADANS_FIND(dds_create_reader);
  KADANS_FIND(dds_create_qos);
  KADANS_FIND(dds_delete_qos);
  KADANS_FIND(dds_qset_reliability);
  KADANS_FIND(dds_qset_durability);
  KADANS_FIND(dds_qset_history);
  KADANS_FIND(dds_write);
  KADANS_FIND(dds_take);
  KADANS_FIND(dds_return_loan);
  KADANS_FIND(dds_delete);
  KADANS_FIND(dds_strretcode);
  KADANS_FIND(dds_set_log_sink);
#undef KADANS_FIND
  return api;
}

}  // namespace

const DdsApi& dds_api() {
  static const DdsApi api = load();
  return api;
}

}  // namespace kadans
