// The text of an MJCF with its <include>s put in, which remembers where each line came from.
#pragma once

#include <string>
#include <vector>

#include "kadans/signal/input_error.h"

namespace kadans {

class MjcfSource {
 public:
  // `file` is where the text comes from. Throws InputError for an included file that cannot be read or includes itself,
  // and when all of it is too large.
  MjcfSource(const std::string& text, const std::string& file);

  const std::string& text() const noexcept { return text_; }
  // The same problems, told of the files and lines that they stand in.
  std::vector<InputProblem> placed(std::vector<InputProblem> problems) const;

 private:
  struct Line {
    std::size_t file = 0;
    int line = 0;
  };

  void add(const std::string& text, const std::string& file, std::vector<std::string>& open);
  void add_text(std::string_view text, std::size_t file, int& line);

  std::string text_;
  std::vector<std::string> files_;
  std::vector<Line> lines_;  // of text_
};

}  // namespace kadans
