// The meshes of bodies in a ResultFile.
#include "dataset.h"
#include "floe/output/reduced_file.h"
#include "floe/output/result_file.h"
#include "floe/petsc/error.h"
#include "reduced_file_hdf5.h"
#include "shape_rows.h"
#include "writing.h"

namespace floe::output {

void ResultFile::write_shapes(const std::string& group, std::int64_t nodes, std::int64_t columns,
                              const ReducedShapes& shapes, const Label& basis) {
  const std::int64_t cells = sum(comm_, std::ssize(shapes.cells));
  open_draft();
  reserve_in_draft(8 * (nodes * (3 + columns * shapes.dofs_per_node) + cells * cell_width));
  writing(path_, [&] {
    const Shares shares(comm_, nodes);
    const NodeRows rows(comm_, shares, shapes.nodes);
    write_positions(comm_, draft_, group, nodes, rows, shapes);
    write_cells(comm_, draft_, group + "/cells", cells, cells_in_order(comm_, shares, shapes.cells));
    if (columns > 0) write_columns(comm_, draft_, group + "/basis", columns, nodes, rows, shapes, basis);
  });
}

void ResultFile::write_vectors(const std::string& name, std::int64_t nodes, std::int64_t columns,
                               const ReducedShapes& shapes, const Label& label) {
  open_draft();
  reserve_in_draft(8 * nodes * columns * shapes.dofs_per_node);
  writing(path_, [&] {
    const Shares shares(comm_, nodes);
    write_columns(comm_, draft_, name, columns, nodes, NodeRows(comm_, shares, shapes.nodes), shapes, label);
  });
}

void ResultFile::write_of_nodes(const std::string& name, std::int64_t nodes, std::int64_t columns,
                                const ReducedShapes& shapes, std::span<const double> rows, const Label& label) {
  open_draft();
  reserve_in_draft(8 * nodes * columns);
  writing(path_, [&] {
    const NodeRows order(comm_, Shares(comm_, nodes), shapes.nodes);
    write_shared(comm_, draft_, name, {hsize_t(nodes), hsize_t(columns)}, order.first(),
                 order.in_order(rows, static_cast<int>(columns)), label);
  });
}

void ResultFile::write_link(const std::string& name, const std::filesystem::path& file, const std::string& object) {
  open_draft();
  petsc::agree(comm_, [&] {
    writing(path_, [&] {
      const Hid groups(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
      check_hdf5(H5Pset_create_intermediate_group(groups, 1));
      check_hdf5(H5Lcreate_external(std::filesystem::absolute(file).c_str(), object.c_str(), draft_, name.c_str(),
                                    groups, H5P_DEFAULT));
    });
  });
}

}  // namespace floe::output
