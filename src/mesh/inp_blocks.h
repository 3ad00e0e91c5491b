#pragma once
#include <deque>
#include <functional>
#include <map>
#include <memory>

#include "faults.h"
#include "mapped_file.h"

namespace floe::mesh {

/// Lines without a keyword between; comments and blank lines among them do not count.
struct InpLines {
  int file;
  const char *begin, *end;
  long long first_line, count;
};

/// A keyword, its parameters and its data lines, which an *INCLUDE may interrupt.
struct InpBlock {
  Where where;
  std::string name;                               // as written, for messages
  std::string keyword;                            // upper case, without blanks: ENDSTEP
  std::map<std::string, std::string> parameters;  // key in upper case without blanks; value without quotes
  std::vector<InpLines> data;

  long long lines() const;
  /// Calls visit(where, line) for `count` data lines from `first` on.
  void each_line(long long first, long long count, const std::function<void(Where, std::string_view)>& visit) const;
  void each_line(const std::function<void(Where, std::string_view)>& visit) const { each_line(0, lines(), visit); }
};

/// A deck as blocks, its includes in place; `files` and `written` keep the text that the blocks point to.
struct InpBlocks {
  std::vector<std::unique_ptr<MappedFile>> files;
  std::deque<std::string> written;  // lines that replace those of the files
  std::vector<InpBlock> blocks;
};

/// Walks the deck once; lines that are no part of a block become faults. Rank-local.
/// @throws InputError  a file that cannot be read, or that includes itself
InpBlocks inp_blocks(const std::string& path, Faults& faults);

/// The values between commas, without blanks around them; those at the end that are empty are dropped.
void split_fields(std::string_view line, std::vector<std::string_view>& fields);

/// Upper case, without blanks.
std::string folded(std::string_view text);

}  // namespace floe::mesh
