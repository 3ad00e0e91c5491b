#include "faults.h"

#include <algorithm>

#include "floe/error.h"
#include "floe/mesh/exchange.h"

namespace floe::mesh {

int Faults::add_file(const std::string& path) {
  files_.push_back(path);
  return static_cast<int>(files_.size()) - 1;
}

std::string Faults::text_of(Where where) const {
  return files_.at(where.file) + (binary_ ? ": byte " : ":") + std::to_string(where.at);
}

void Faults::add(Where where, const std::string& text) {
  Fault fault{where, text};
  const auto place = std::lower_bound(faults_.begin(), faults_.end(), fault);
  if (place != faults_.end() && *place == fault) return;
  faults_.insert(place, std::move(fault));
  if (faults_.size() > most_ + 1) faults_.pop_back();
}

Faults Faults::together(MPI_Comm comm) const {
  std::vector<std::string> texts;
  for (const auto& [where, text] : faults_) {
    texts.push_back(std::to_string(where.file));
    texts.push_back(std::to_string(where.at));
    texts.push_back(text);
  }
  const auto all = gather_texts(comm, texts);
  Faults result(*this);
  for (std::size_t i = 0; i + 2 < all.size(); i += 3)
    result.add({std::stoi(all[i]), std::stoll(all[i + 1])}, all[i + 2]);
  return result;
}

void Faults::shorten(std::vector<std::string>& lines) const {
  if (lines.size() <= most_) return;
  lines.resize(most_);
  lines.push_back("and more: the first " + std::to_string(most_) + " are listed");
}

void Faults::throw_together(MPI_Comm comm) const {
  const Faults all = together(comm);
  if (!all.any()) return;
  std::vector<std::string> lines;
  for (const auto& [where, text] : all.faults_) lines.push_back(text_of(where) + ": " + text);
  shorten(lines);
  throw InputError(lines);
}

std::vector<std::string> Faults::texts_together(MPI_Comm comm) const {
  std::vector<std::string> lines;
  for (const auto& [where, text] : together(comm).faults_) lines.push_back(text);
  shorten(lines);
  return lines;
}

std::vector<std::string> gather_texts(MPI_Comm comm, const std::vector<std::string>& texts) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::string mine;
  for (const auto& text : texts) mine += std::string(text).substr(0, text.find('\0')) + '\0';
  std::vector<int> counts(ranks), starts(ranks + 1, 0);
  const int count = static_cast<int>(mine.size());
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  std::partial_sum(counts.begin(), counts.end(), starts.begin() + 1);
  std::string all(starts.back(), '\0');
  MPI_Allgatherv(mine.data(), count, MPI_CHAR, all.data(), counts.data(), starts.data(), MPI_CHAR, comm);
  std::vector<std::string> gathered;
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = all.find('\0', begin);
    gathered.push_back(all.substr(begin, end - begin));
    begin = end + 1;
  }
  return gathered;
}

}  // namespace floe::mesh
