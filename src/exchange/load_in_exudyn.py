"""The body of a `floe export --format exudyn` file in an Exudyn system: add_body(mbs, "blade.npz"), then joints on its nodes."""
import exudyn
import exudyn.itemInterface as items
import numpy as np
from exudyn.rigidBodyUtilities import AngularVelocity2EulerParameters_t, RotationMatrix2EulerParameters

INERTIA = ["physicsMass", "physicsInertia", "physicsCenterOfMass", "mPsiTildePsi", "mPsiTildePsiTilde", "mPhitTPsi",
           "mPhitTPsiTilde", "mXRefTildePsi", "mXRefTildePsiTilde", "modeBasis", "referencePositions"]


def add_body(mbs, path, position=(0, 0, 0), rotation=np.eye(3), velocity=(0, 0, 0), angular_velocity=(0, 0, 0)):
    """@return  object number; nodes of its named places, for MarkerSuperElementPosition(meshNodeNumbers=[...])"""
    body = np.load(path)
    zero, turn = [0.0] * len(body["massMatrixReduced"]), RotationMatrix2EulerParameters(rotation)
    frame = mbs.AddNode(items.NodeRigidBodyEP(
        referenceCoordinates=[*position, *turn],
        initialVelocities=[*velocity, *AngularVelocity2EulerParameters_t(angular_velocity, turn)]))
    elastic = mbs.AddNode(items.NodeGenericODE2(numberOfODE2Coordinates=len(zero), referenceCoordinates=zero,
                                                initialCoordinates=zero, initialCoordinates_t=zero))
    given = {name: body[name] for name in INERTIA} | {"physicsMass": float(body["physicsMass"])}
    for name in ("massMatrixReduced", "stiffnessMatrixReduced", "dampingMatrixReduced"):
        given[name] = exudyn.MatrixContainer()
        given[name].SetWithDenseMatrix(body[name], useDenseMatrix=True)
    number = mbs.AddObject(items.ObjectFFRFreducedOrder(nodeNumbers=[frame, elastic], **given))
    return number, dict(zip(body["placeNames"].tolist(), body["placeNodes"].tolist()))
