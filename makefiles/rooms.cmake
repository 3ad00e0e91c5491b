# Each room (= folder = namespace = target) with the rooms it may use. tests/rooms checks the includes against this list.
#             room        may use
floe_room(petsc)
floe_room(math)
floe_room(mesh        petsc math)
floe_room(fem         mesh body petsc math)
floe_room(body        math)
floe_room(dynamics    body petsc math)
floe_room(reduction   fem body petsc math)
floe_room(reference   dynamics fem body petsc math)
floe_room(output      body petsc math)
floe_room(scene       output reference reduction dynamics fem mesh body petsc math)
floe_room(app         scene output reference reduction dynamics fem mesh body petsc math)
