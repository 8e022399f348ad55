// A participant of a DDS domain with its writers and readers of topics; all end with this object. One thread at a time.
//
// The domain uses only this machine's loopback device without multicast, unless CYCLONEDDS_URI sets something else.
// Incoming samples of more than a few MB are not assembled.
#pragma once

#include <cstdint>
#include <string>

#include "dds_api.h"

namespace kadans {

// The defaults of ROS 2: reliable, keep the newest `depth` samples. A reader that joins late gets nothing, or with
// for_late_readers the newest samples.
struct DdsQuality {
  std::int32_t depth = 10;
  bool for_late_readers = false;
};

class DdsDomain {
 public:
  // Throws InputError when there is no library, when CYCLONEDDS_URI is wrong, or when there is no such device.
  explicit DdsDomain(std::uint32_t domain);
  ~DdsDomain();
  DdsDomain(const DdsDomain&) = delete;
  DdsDomain& operator=(const DdsDomain&) = delete;

  // Both throw InputError.
  dds_entity_t writer(const dds_topic_descriptor_t& type, const std::string& topic, const DdsQuality& quality = {});
  dds_entity_t reader(const dds_topic_descriptor_t& type, const std::string& topic, const DdsQuality& quality = {});

  // False when it could not be written, for example because a reader has not taken the earlier samples for 100 ms.
  // NOLINTNEXTLINE(readability-make-member-function-const): it changes what others see
  bool write(dds_entity_t writer, const void* sample) noexcept { return api_.dds_write(writer, sample) >= 0; }
  // Takes the oldest waiting sample and calls `see` with it if its data are valid. False: no sample is waiting.
  template <typename Sample, typename See>
  bool take(dds_entity_t reader, See&& see) {
    void* sample = nullptr;
    dds_sample_info_t info{};
    if (api_.dds_take(reader, &sample, &info, 1, 1) <= 0) return false;
    struct Loan {
      const DdsApi& api;
      dds_entity_t from;
      void** sample;
      ~Loan() { (void)api.dds_return_loan(from, sample, 1); }
    } const loan{api_, reader, &sample};
    if (info.valid_data) see(*static_cast<const Sample*>(sample));
    return true;
  }

 private:
  dds_entity_t topic(const dds_topic_descriptor_t& type, const std::string& name) const;
  dds_entity_t checked(dds_entity_t entity, const std::string& what) const;
  template <typename Create>
  dds_entity_t with_quality(const DdsQuality& quality, Create&& create) const;

  const DdsApi& api_;
  std::uint32_t number_;
  dds_entity_t domain_ = 0, participant_ = 0;
};

}  // namespace kadans
