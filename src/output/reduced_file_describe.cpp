#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "floe/output/reduced_file.h"
#include "floe/output/table.h"

namespace floe::output {
namespace {

Cell known(bool is, double value) { return is ? Cell(value) : Cell(std::string()); }
double hertz(double omega) { return omega / (2 * std::numbers::pi); }

std::string vector_text(const Eigen::VectorXd& x) {
  std::string text;
  for (const double each : x) text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ", each);
  return "(" + text + ")";
}

std::string frame_text(const ReducedFrame& frame) {
  std::string text = fmt::format("{}, origin {} m", frame.kind, vector_text(frame.origin));
  for (Eigen::Index i = 0; i < frame.axes.cols(); ++i)
    text += fmt::format(", {} along {}", "xyz"[i], vector_text(frame.axes.col(i)));
  return text;
}

Table frequencies(const ReducedBodyFile& file) {
  Table table{{{"frequency", ""}, {"value", "Hz", 6}, {"residual", "", 2}}, {}};
  for (std::size_t i = 0; i < file.omega.size(); ++i)
    table.rows.push_back({static_cast<std::int64_t>(i + 1), hertz(file.omega[i]), file.residual[i]});
  return table;
}

std::string name_of(const ReducedColumn& column) {
  return column.label.starts_with(column.kind) ? column.label : column.kind + " " + column.label;
}

Table columns(const ReducedBodyFile& file) {
  Table table{{{"column", ""}, {"frequency", "Hz", 6}, {"new part", "", 3}, {"kept", ""}}, {}};
  const bool ranked =
      std::any_of(file.columns.begin(), file.columns.end(), [](const auto& each) { return each.interaction > 0; });
  if (ranked) table.columns.push_back({"interaction", "", 3});
  for (const auto& column : file.columns) {
    table.rows.push_back({name_of(column), known(column.kind == "mode", hertz(column.omega)), column.new_part,
                          column.kept ? "yes" : "no"});
    if (ranked) table.rows.back().push_back(known(column.interaction > 0, column.interaction));
  }
  return table;
}

/// `attachment tip.fx (repeats root.fx)`: static columns that the basis lacks, the first of them.
std::string left_out(const ReducedBodyFile& file) {
  constexpr std::size_t shown = 10;
  std::vector<std::string> all;
  for (const auto& column : file.columns)
    if (column.kind == "attachment" && !column.kept)
      all.push_back(fmt::format(
          "{} ({})", name_of(column),
          column.dropped.empty()
              ? fmt::format("all but {:.2g} of it is contained in the span of the previous ones", column.new_part)
              : column.dropped));
  if (all.empty()) return {};
  const std::size_t more = all.size() - std::min(all.size(), shown);
  all.resize(all.size() - more);
  return fmt::format("dropped     {}{}\n", fmt::join(all, ", "), more > 0 ? fmt::format(", and {} more", more) : "");
}

Table places(const ReducedBodyFile& file) {
  Table table{{{"place", ""}}, {}};
  for (int i = 0; i < file.dimension; ++i) table.columns.push_back({fmt::format("{} in frame", "xyz"[i]), "m", 6});
  for (const auto& place : file.places) {
    table.rows.push_back({place.name});
    for (const double each : place.map.x) table.rows.back().emplace_back(each);
  }
  return table;
}

std::string made_text(const MadeBy& made) {
  std::string text = fmt::format("made by     floe {} ({}) on {}, {} rank{}\n", made.version, made.commit, made.date,
                                 made.ranks, made.ranks == 1 ? "" : "s");
  if (!made.command.empty()) text += "command     " + made.command + "\n";
  if (!made.options.empty()) text += "options     " + made.options + "\n";
  for (const auto& [phase, seconds] : made.seconds) text += fmt::format("            {:.3g} s {}\n", seconds, phase);
  return text;
}

std::int64_t numbers_of(const body::Inertia& inertia) {
  const std::int64_t d = inertia.dimension(), k = inertia.coordinates();
  return 1 + d + d * d + d * k + d * d * (k + k * k * (inertia.W.empty() ? 1 : 2)) +
         (inertia.Q.empty() ? 0 : d * k * k);
}

}  // namespace

std::int64_t online_bytes(const ReducedBodyFile& file) {
  const auto& elasticity = file.body.elasticity;
  std::int64_t numbers = numbers_of(file.body.inertia) + numbers_of(file.body.line) + elasticity.bending.size() +
                         elasticity.F.size() + file.damping.size();
  for (const auto& place : file.places)
    numbers += place.map.x.size() + place.map.S.size() + place.map.psi.size() +
               (place.map.Q.empty() ? 0 : place.map.x.size() * file.body.coordinates() * file.body.coordinates()) +
               9 * static_cast<std::int64_t>(place.map.H.size());
  for (const auto& [part, unit] : file.pressures)
    numbers += 15 + 16 * unit.coordinates() + unit.coordinates() * unit.coordinates();
  return numbers * static_cast<std::int64_t>(sizeof(double)) +
         static_cast<std::int64_t>(elasticity.pairs.size() * sizeof(elasticity.pairs[0]));
}

std::string describe(const ReducedBodyFile& file) {
  const auto& elasticity = file.body.elasticity;
  const auto kept = std::count_if(file.columns.begin(), file.columns.end(), [](const auto& each) { return each.kept; });
  std::string text =
      fmt::format("body        {}, {} dimensions, {:.6g} kg\n", file.name, file.dimension, file.body.inertia.m);
  text += fmt::format("mesh        {} dofs, {} nodes, {} elements\n", file.dofs, file.nodes, file.cells);
  text += fmt::format("frame       {}\n", frame_text(file.frame));
  if (file.held)
    text += fmt::format("modes       constrained by {}\n",
                        file.held->empty() ? "nothing" : fmt::format("{}", fmt::join(*file.held, ", ")));
  text += fmt::format("basis       {} coordinates of {} candidate vectors\n", kept, file.columns.size());
  text += left_out(file);
  const std::string of =
      file.omitted_products > 0 ? fmt::format(" of {}", elasticity.pairs.size() + file.omitted_products) : "";
  text += fmt::format("energy      {} squares of {} coordinates and {}{} products\n", elasticity.F.rows(),
                      elasticity.bending.rows(), elasticity.pairs.size(), of);
  text += fmt::format("damping     {}\n", file.damping.size() ? "yes" : "none");
  text += fmt::format("online      {:.1f} kB\n", static_cast<double>(online_bytes(file)) / 1000);
  text += fmt::format("shapes      {}\n", file.has_shapes ? "of all nodes" : "none");
  text += made_text(file.made);
  for (const Table& table : {frequencies(file), columns(file), places(file)})
    if (!table.rows.empty()) text += "\n" + to_text(table);
  return text;
}

}  // namespace floe::output
