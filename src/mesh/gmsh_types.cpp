#include "gmsh_structure.h"

namespace floe::mesh {

const GmshType* gmsh_type(long long type) {
  static const std::map<long long, GmshType> types{
      {1, {"line of 2 nodes", 2, CellKind::line}},
      {2, {"triangle of 3 nodes", 3, CellKind::triangle}},
      {3, {"quadrilateral of 4 nodes", 4, CellKind::quadrilateral}},
      {4, {"tetrahedron of 4 nodes", 4}},
      {5, {"hexahedron of 8 nodes", 8}},
      {6, {"prism of 6 nodes", 6}},
      {7, {"pyramid of 5 nodes", 5}},
      {8, {"second-order line of 3 nodes", 3, CellKind::line3}},
      {9, {"second-order triangle of 6 nodes", 6, CellKind::triangle6}},
      {10, {"second-order quadrilateral of 9 nodes", 9, CellKind::quadrilateral8}},
      {11, {"second-order tetrahedron of 10 nodes", 10}},
      {12, {"second-order hexahedron of 27 nodes", 27}},
      {13, {"second-order prism of 18 nodes", 18}},
      {14, {"second-order pyramid of 14 nodes", 14}},
      {15, {"point", 1}},
      {16, {"second-order quadrilateral of 8 nodes", 8, CellKind::quadrilateral8}},
      {17, {"second-order hexahedron of 20 nodes", 20}},
      {18, {"second-order prism of 15 nodes", 15}},
      {19, {"second-order pyramid of 13 nodes", 13}},
      {20, {"third-order triangle of 9 nodes", 9}},
      {21, {"third-order triangle of 10 nodes", 10}},
      {22, {"fourth-order triangle of 12 nodes", 12}},
      {23, {"fourth-order triangle of 15 nodes", 15}},
      {24, {"fifth-order triangle of 15 nodes", 15}},
      {25, {"fifth-order triangle of 21 nodes", 21}},
      {26, {"third-order line of 4 nodes", 4}},
      {27, {"fourth-order line of 5 nodes", 5}},
      {28, {"fifth-order line of 6 nodes", 6}},
      {29, {"third-order tetrahedron of 20 nodes", 20}},
      {30, {"fourth-order tetrahedron of 35 nodes", 35}},
      {31, {"fifth-order tetrahedron of 56 nodes", 56}},
      {92, {"third-order hexahedron of 64 nodes", 64}},
      {93, {"fourth-order hexahedron of 125 nodes", 125}},
  };
  const auto found = types.find(type);
  return found == types.end() ? nullptr : &found->second;
}

int gmsh_dimension(long long type) {
  switch (type) {
    case 15:
      return 0;
    case 1:
    case 8:
    case 26:
    case 27:
    case 28:
      return 1;
    case 2:
    case 3:
    case 9:
    case 10:
    case 16:
    case 20:
    case 21:
    case 22:
    case 23:
    case 24:
    case 25:
      return 2;
    default:
      return 3;
  }
}

}  // namespace floe::mesh
