#include "reduced_file_image.h"

#include <fmt/format.h>

#include <algorithm>

#include "reduced_file_hdf5.h"

namespace floe::output {
namespace {

using Numbers = std::vector<double>;

hsize_t extent(Eigen::Index n) { return static_cast<hsize_t>(n); }

void append(Numbers& all, const Eigen::MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) all.push_back(matrix(i, j));
}

/// Puts datasets into a file and sums them up: FNV-1a, 64 bits.
class Writer {
 public:
  explicit Writer(hid_t file) : file_(file) {}
  std::int64_t checksum() const { return static_cast<std::int64_t>(sum_); }
  void numbers(const std::string& name, const Extent& shape, const Numbers& data, const std::string& unit,
               const std::string& description = "") {
    write_whole<double>(file_, name, shape, data, {unit, description});
    add(name), add(std::as_bytes(std::span(data)));
  }
  void integers(const std::string& name, const Extent& shape, const std::vector<std::int64_t>& data,
                const std::string& description = "") {
    write_whole<std::int64_t>(file_, name, shape, data, {"", description});
    add(name), add(std::as_bytes(std::span(data)));
  }
  void matrix(const std::string& name, const Eigen::MatrixXd& matrix, const std::string& unit,
              const std::string& description = "") {
    Numbers all;
    append(all, matrix);
    numbers(name, {extent(matrix.rows()), extent(matrix.cols())}, all, unit, description);
  }
  void texts(const std::string& name, const std::vector<std::string>& all, const std::string& description = "") {
    write_texts(file_, name, all, {"", description});
    add(name);
    for (const auto& each : all) add(each);
  }
  /// Left out of the sum, as the next, so that a floe that does not know them finds its sum, too.
  void count(const std::string& name, std::int64_t one, const std::string& description) {
    write_whole<std::int64_t>(file_, name, {}, std::span(&one, 1), {"", description});
  }
  void remarks(const std::string& name, const std::vector<std::string>& all, const std::string& description) {
    write_texts(file_, name, all, {"", description});
  }
  void text(const std::string& name, const std::string& one) {
    write_text(file_, name, one);
    add(name), add(one);
  }

 private:
  void add(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) sum_ = (sum_ ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
  }
  void add(const std::string& text) { add(std::as_bytes(std::span(text.c_str(), text.size() + 1))); }
  hid_t file_;
  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

/// Units of m, s0, C0, S, h, of M and W, and of Q.
using InertiaUnits = std::array<const char*, 7>;
constexpr InertiaUnits of_mass = {"kg", "kg m", "kg m^2", "kg^1/2", "kg^1/2 m", "1", "m^-1"};
constexpr InertiaUnits of_line = {"m", "m^2", "m^3", "m kg^-1/2", "m^2 kg^-1/2", "m kg^-1", "kg^-1"};

void put(Writer& to, const std::string& group, const body::Inertia& inertia, const InertiaUnits& units) {
  const hsize_t d = extent(inertia.dimension()), k = extent(inertia.coordinates());
  to.numbers(group + "/m", {}, {inertia.m}, units[0]);
  to.numbers(group + "/s0", {d}, {inertia.s0.begin(), inertia.s0.end()}, units[1]);
  to.matrix(group + "/C0", inertia.C0, units[2]);
  to.matrix(group + "/S", inertia.S, units[3]);
  Numbers h, M;
  for (const auto& row : inertia.h)
    for (const auto& each : row) append(h, each);
  for (const auto& row : inertia.M)
    for (const auto& each : row) append(M, each);
  to.numbers(group + "/h", {d, d, k}, h, units[4], "[a][b]: int rho x_a N_b");
  to.numbers(group + "/M", {d, d, k, k}, M, units[5], "[a][b]: int rho N_a' N_b");
  Numbers Q, W;
  for (const auto& each : inertia.Q) append(Q, each);
  if (!inertia.Q.empty())
    to.numbers(group + "/Q", {d, k, k}, Q, units[6], "[a]: q' Q q = int rho n_a, n = theta x (theta x c); symmetric");
  if (inertia.W.empty()) return;
  for (const auto& row : inertia.W)
    for (const auto& each : row) append(W, each);
  to.numbers(group + "/W", {d, d, k, k}, W, units[5],
             "[a][b]: q' W q = int rho x_a n_b, n/2 the displacement of second order of what rotates; symmetric");
}

void put(Writer& to, const body::Elasticity& elasticity) {
  std::vector<std::int64_t> pairs;
  for (const auto& [a, b] : elasticity.pairs) pairs.insert(pairs.end(), {a, b});
  to.matrix("elasticity/bending", elasticity.bending, "s^-2");
  to.matrix("elasticity/F", elasticity.F, "s^-1; pairs: kg^-1/2 m^-1 s^-1",
            "U = 1/2 q' bending q + 1/2 |F (q, s)|^2, s = q_a q_b of the pairs, 1/2 q_a^2 where a = b");
  to.integers("elasticity/pairs", {elasticity.pairs.size(), 2}, pairs, "a <= b, from 0");
}

/// Of a place without an arm the displacement of second order is zero, given or not.
bool has_second_order(const ReducedPlace& place) {
  return std::any_of(place.map.Q.begin(), place.map.Q.end(), [](const auto& form) { return !form.isZero(0); });
}

void put(Writer& to, const std::vector<ReducedPlace>& places, hsize_t d, hsize_t k) {
  std::vector<std::string> names;
  Numbers x, S, psi, Q, H;
  for (const auto& place : places) {
    names.push_back(place.name);
    append(x, place.map.x);
    append(S, place.map.S);
    append(psi, place.map.psi);
    for (hsize_t a = 0; a < d; ++a)
      append(Q, has_second_order(place) ? place.map.Q[a] : Eigen::MatrixXd::Zero(k, k).eval());
    for (std::size_t a = 0; a < 3; ++a)
      append(H, place.map.H.empty() ? Eigen::MatrixXd::Zero(3, 3).eval() : Eigen::MatrixXd(place.map.H[a]));
  }
  const hsize_t n = places.size();
  to.texts("places/names", names);
  to.numbers("places/x", {n, d}, x, "m", "undeformed, in the axes of the floating frame");
  to.numbers("places/S", {n, d, k}, S, "kg^-1/2", "displacement S q");
  if (std::any_of(places.begin(), places.end(), has_second_order))
    to.numbers("places/Q", {n, d, k, k}, Q, "m^-1 kg^-1", "second-order displacement q' Q_a q / 2; symmetric");
  to.numbers("places/psi", {n, d == 2 ? hsize_t{1} : 3, k}, psi, "rad m^-1 kg^-1/2", "b = psi q of the rotation");
  if (std::any_of(places.begin(), places.end(), [](const ReducedPlace& place) { return !place.map.H.empty(); }))
    to.numbers("places/H", {n, 3, 3, 3}, H, "rad^-1", "second-order rotation b' H_a b / 2, added to b; symmetric");
}

void put(Writer& to, const std::vector<ReducedPressure>& pressures, hsize_t k) {
  if (pressures.empty()) return;
  std::vector<std::string> parts;
  Numbers force, moment, force_by, moment_by, load, load_by, spread, spread_by;
  for (const auto& [part, unit] : pressures) {
    parts.push_back(part);
    append(force, unit.force), append(moment, unit.moment), append(load, unit.load), append(load_by, unit.load_by);
    append(force_by, unit.force_by), append(moment_by, unit.moment_by), append(spread, unit.spread);
    for (const Eigen::Matrix3d& each : unit.spread_by) append(spread_by, each);
  }
  const hsize_t n = pressures.size();
  to.texts("pressure/parts", parts, "of the mesh, with shells");
  to.numbers("pressure/force", {n, 3}, force, "m^2", "int n dA");
  to.numbers("pressure/force_by", {n, 3, k}, force_by, "m kg^-1/2", "int L dA, n dA + L q dA the area that follows");
  to.numbers("pressure/moment", {n, 3}, moment, "m^3", "int x cross n dA");
  to.numbers("pressure/moment_by", {n, 3, k}, moment_by, "m^2 kg^-1/2", "int (x cross L - n cross N) dA");
  to.numbers("pressure/load", {n, k}, load, "m^2 kg^-1/2", "int N'n dA");
  to.numbers("pressure/load_by", {n, k, k}, load_by, "m kg^-1", "int N'L dA");
  to.numbers("pressure/spread", {n, 3, 3}, spread, "m^3", "int x n' dA");
  to.numbers("pressure/spread_by", {n, k, 3, 3}, spread_by, "m^2 kg^-1/2", "int N_j n' dA of each coordinate");
}

void put(Writer& to, const std::vector<ReducedColumn>& columns) {
  std::vector<std::string> kinds, labels, dropped;
  Numbers omega, new_part, interaction;
  std::vector<std::int64_t> kept;
  for (const auto& column : columns) {
    kinds.push_back(column.kind);
    labels.push_back(column.label);
    omega.push_back(column.omega);
    new_part.push_back(column.new_part);
    interaction.push_back(column.interaction);
    kept.push_back(column.kept);
    dropped.push_back(column.dropped);
  }
  const Extent shape{columns.size()};
  to.texts("columns/kind", kinds, "mode, derivative or attachment");
  to.texts("columns/label", labels);
  to.numbers("columns/omega", shape, omega, "rad/s", "of modes");
  to.numbers("columns/new_part", shape, new_part, "1", "part not contained in the span of the previous vectors");
  to.numbers("columns/interaction", shape, interaction, "1", "relative to the maximum");
  to.integers("columns/kept", shape, kept, "1: in the basis");
  if (std::any_of(dropped.begin(), dropped.end(), [](const std::string& each) { return !each.empty(); }))
    to.remarks("columns/dropped", dropped, "why an attachment mode was not a candidate");
}

void put(Writer& to, const MadeBy& made) {
  to.text("made/version", made.version);
  to.text("made/commit", made.commit);
  to.text("made/date", made.date);
  to.text("made/command", made.command);
  to.text("made/options", made.options);
  to.text("made/scene", made.scene);
  to.integers("made/ranks", {}, {made.ranks});
  std::vector<std::string> phases;
  Numbers seconds;
  for (const auto& [phase, time] : made.seconds) phases.push_back(phase), seconds.push_back(time);
  to.texts("made/phases", phases);
  to.numbers("made/seconds", {phases.size()}, seconds, "s", "of each phase");
}

void put(Writer& to, const ReducedBodyFile& file) {
  const hsize_t d = file.dimension, k = extent(file.body.coordinates());
  to.text("body/name", file.name);
  to.integers("body/dimension", {}, {file.dimension});
  to.integers("body/dofs", {}, {file.dofs});
  to.integers("body/nodes", {}, {file.nodes});
  to.integers("body/cells", {}, {file.cells});
  put(to, "inertia", file.body.inertia, of_mass);
  put(to, "line", file.body.line, of_line);
  put(to, file.body.elasticity);
  if (file.omitted_products > 0)
    to.count("elasticity/omitted", file.omitted_products, "pairs left out, whose products do little");
  to.matrix("damping", file.damping, "s^-1", "of small motions of the coordinates; 0 x 0 for none");
  if (file.version >= 3)
    to.numbers("strain_rate_damping", {}, {file.strain_rate_damping}, "s",
               "beta of Kelvin-Voigt, in damping as beta K");
  put(to, file.places, d, k);
  put(to, file.pressures, k);
  put(to, file.columns);
  to.numbers("frequencies/omega", {file.omega.size()}, file.omega, "rad/s");
  to.numbers("frequencies/residual", {file.residual.size()}, file.residual, "1", "relative, of each omega");
  to.text("frame/kind", file.frame.kind);
  to.numbers("frame/origin", {d}, {file.frame.origin.begin(), file.frame.origin.end()}, "m", "in the mesh");
  to.matrix("frame/axes", file.frame.axes, "1", "columns: x_mesh = origin + axes x");
  if (file.held) to.remarks("frequencies/held", *file.held, "by what the modes are constrained besides the frame");
  put(to, file.made);
}

Hid in_memory() {
  silence_hdf5();
  Hid access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  check_hdf5(H5Pset_fapl_core(access, 1 << 20, false));
  return access;
}

}  // namespace

Hid create_image() {
  const Hid access = in_memory(), how = plain_object(H5P_FILE_CREATE);
  return Hid(H5Fcreate("floe in memory", H5F_ACC_TRUNC, how, access), H5Fclose);
}

std::vector<char> bytes_of(hid_t memory) {
  check_hdf5(H5Fflush(memory, H5F_SCOPE_LOCAL));
  const ssize_t size = H5Fget_file_image(memory, nullptr, 0);
  check_hdf5(size < 0 ? -1 : 0);
  std::vector<char> bytes(size);
  check_hdf5(H5Fget_file_image(memory, bytes.data(), bytes.size()) < 0 ? -1 : 0);
  return bytes;
}

Image image_of(const ReducedBodyFile& file, bool complete) {
  const Hid memory = create_image();
  write_attribute(memory, "format", reduced_format);
  write_flag(memory, "version", file.version);
  write_flag(memory, "shapes", file.has_shapes);
  Writer writer(memory);
  put(writer, file);
  write_flag(memory, "checksum", writer.checksum());
  write_flag(memory, "complete", complete);
  return {bytes_of(memory), writer.checksum()};
}

Hid open_image(std::vector<char>& bytes) {
  const Hid access = in_memory();
  check_hdf5(H5Pset_file_image(access, bytes.data(), bytes.size()));
  return Hid(H5Fopen("floe in memory", H5F_ACC_RDONLY, access), H5Fclose);
}

}  // namespace floe::output
