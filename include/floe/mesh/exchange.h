#pragma once
#include <mpi.h>

#include <numeric>
#include <type_traits>
#include <vector>

namespace floe::mesh {

/// What came from each rank, one after the other: from rank r entries [starts[r], starts[r + 1]).
template <class T>
struct Received {
  std::vector<T> values;
  std::vector<int> counts, starts;
};

/// Sends counts[r] entries to rank r; `values` holds them one rank after the other. Collective.
template <class T>
Received<T> exchange(MPI_Comm comm, const std::vector<T>& values, const std::vector<int>& counts) {
  static_assert(std::is_trivially_copyable_v<T>);
  const int ranks = static_cast<int>(counts.size());
  const auto starts_of_counts = [&](const std::vector<int>& n) {
    std::vector<int> starts(ranks + 1, 0);
    std::partial_sum(n.begin(), n.end(), starts.begin() + 1);
    return starts;
  };
  Received<T> received;
  received.counts.resize(ranks);
  MPI_Alltoall(counts.data(), 1, MPI_INT, received.counts.data(), 1, MPI_INT, comm);
  const auto starts = starts_of_counts(counts);
  received.starts = starts_of_counts(received.counts);
  received.values.resize(received.starts.back());
  MPI_Datatype type;
  MPI_Type_contiguous(sizeof(T), MPI_BYTE, &type);
  MPI_Type_commit(&type);
  MPI_Alltoallv(values.data(), counts.data(), starts.data(), type, received.values.data(), received.counts.data(),
                received.starts.data(), type, comm);
  MPI_Type_free(&type);
  return received;
}

/// Sends each value to the rank that `destination(value)` names. `order`, where given, becomes the place among the sent
/// values of each value. Collective.
template <class T, class Destination>
Received<T> scatter(MPI_Comm comm, const std::vector<T>& values, Destination&& destination,
                    std::vector<int>* order = nullptr) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<int> counts(ranks, 0), next(ranks + 1, 0), place(values.size());
  for (const auto& value : values) ++counts[destination(value)];
  std::partial_sum(counts.begin(), counts.end(), next.begin() + 1);
  std::vector<T> sorted(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    place[i] = next[destination(values[i])]++;
    sorted[place[i]] = values[i];
  }
  if (order) *order = std::move(place);
  return exchange(comm, sorted, counts);
}

/// Answers each question at the rank that `destination(question)` names. Collective.
/// @param respond  called there with (question)
template <class Answer, class Question, class Destination, class Respond>
std::vector<Answer> ask(MPI_Comm comm, const std::vector<Question>& questions, Destination&& destination,
                        Respond&& respond) {
  std::vector<int> order;
  const auto asked = scatter(comm, questions, destination, &order);
  std::vector<Answer> answers(asked.values.size());
  for (std::size_t i = 0; i < answers.size(); ++i) answers[i] = respond(asked.values[i]);
  const auto back = exchange(comm, answers, asked.counts);
  std::vector<Answer> mine(questions.size());
  for (std::size_t i = 0; i < mine.size(); ++i) mine[i] = back.values[order[i]];
  return mine;
}

}  // namespace floe::mesh
