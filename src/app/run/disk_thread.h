// Forces the open record and the newest flight record to the disk, once a second, so that a loss of power costs little
// more than that. It has a thread of its own, because a slow disk holds it up for seconds, and the record's thread must
// not wait for that.
#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "remote/instance/record_side.h"

namespace kadans {

class DiskThread {
 public:
  explicit DiskThread(RecordSide& records) : records_(records) {}

  // Throws std::system_error.
  void start();
  // Forces what is there to the disk a last time, and waits for that.
  void stop() { thread_ = {}; }

 private:
  // One file, also after it was completed, until another takes its place.
  struct Kept {
    std::string path;
    int descriptor = -1;

    void sync(const std::string& newest);
    void close() noexcept;
  };
  void sync();
  void work(const std::stop_token& stop);

  RecordSide& records_;
  Kept record_, flight_;
  std::mutex mutex_;
  std::condition_variable_any told_;
  std::jthread thread_;  // last: it uses all others
};

}  // namespace kadans
