"""Readers of the formats, by their public descriptions; nothing of the writers."""
import re
import xml.etree.ElementTree as xml

import numpy as np


def matrix_market(path):
    lines = path.read_text().splitlines()
    assert lines[0].lower() == "%%matrixmarket matrix coordinate real symmetric"
    lines = [line for line in lines if not line.startswith("%")]
    rows, columns, entries = map(int, lines[0].split())
    assert len(lines) == 1 + entries
    matrix = np.zeros((rows, columns))
    for line in lines[1:]:
        i, j, value = line.split()
        i, j = int(i) - 1, int(j) - 1
        assert i >= j and matrix[i, j] == 0
        matrix[i, j] = matrix[j, i] = float(value)
    return matrix


class Taylor:
    def __init__(self, header):
        rows, columns, nq = header["nrow"], header["ncol"], header["nq"]
        self.order, self.structure = header["order"], header["structure"]
        self.m0, self.m1 = np.zeros((rows, columns)), np.zeros((rows, nq, columns))
        if self.structure == 4:
            self.m0 = np.eye(rows)

    def at(self, q):
        return self.m0 + np.einsum("riq,i->rq", self.m1, q)


class Sid:
    """Objects of the file: `new CLASS = ...` or NAME ... end NAME; KEY = VALUE; m0( r, c) = ..., m1( r, i, c) = ..."""

    def __init__(self, path):
        lines = path.read_text().splitlines()
        self.heading, self.lines = lines[0], iter(lines[1:])
        self.node_count, self.mode_count = map(int, self.heading.split(":")[0].split())
        self.nodes, self.terms, self.modes, self.mass = {}, {}, [], None
        self.expect("part")
        self.expect("new modal")
        self.expect("refmod")
        self.refmod()
        self.expect("frame")
        while (line := next(self.lines).strip()) != "end frame":
            assert line.startswith("new node")
            self.node(int(line.split("=")[1]))
        while (line := next(self.lines).strip()) != "end modal":
            self.terms[line] = self.taylor(line)
        self.expect("end part")
        assert next(self.lines, None) is None
        assert len(self.nodes) == self.node_count and len(self.modes) == self.mode_count

    def expect(self, word):
        line = next(self.lines)
        assert line.split("=")[0].strip() == word, (line, word)

    def refmod(self):
        while (line := next(self.lines).strip()) != "end refmod":
            key, value = (part.strip() for part in line.split("=", 1))
            if key == "mass":
                self.mass = self.number(value)
            elif key == "nelastq":
                assert int(value) == self.mode_count
            else:
                assert key.startswith("ielastq") and value.startswith("Eigen Mode")
                self.modes.append(float(re.search(r":\s*(\S+) Hz", value).group(1)))

    def node(self, number):
        assert next(self.lines).split("=")[1].strip() == "body ref"
        self.nodes[number] = {}
        while (line := next(self.lines).strip()) != "end node":
            self.nodes[number][line] = self.taylor(line)

    @staticmethod
    def number(text):
        assert re.fullmatch(r"-?\d\.\d+D[+-]\d+", text), text
        return float(text.replace("D", "E"))

    def taylor(self, name):
        header = {}
        for key in ("order", "nrow", "ncol", "nq", "nqn", "structure"):
            found, value = next(self.lines).split("=")
            assert found.strip() == key
            header[key] = int(value)
        assert header["nq"] == self.mode_count and header["nqn"] == 0
        taylor = Taylor(header)
        while (line := next(self.lines).strip()) != f"end {name}":
            key, value = line.split("=")
            which, where = re.fullmatch(r"(m[01])\(([\d, ]+)\)\s*", key).groups()
            index = tuple(int(i) - 1 for i in where.split(","))
            assert taylor.structure == 3 and (which == "m0" or taylor.order == 1)
            getattr(taylor, which)[index] = self.number(value.strip())
        return taylor


BODY = "{http://www.mbsim-env.de/MBSimFlexibleBody}"
VALUE = "{http://www.mbsim-env.de/MBXMLUtils}"
# In the order of MBSim's schema (mbsimflexiblebody.xsd, FlexibleFfrBodyType).
ORDER = ["mass", "positionIntegral", "positionPositionIntegral", "shapeFunctionIntegral",
         "positionShapeFunctionIntegralArray", "shapeFunctionShapeFunctionIntegralArray", "stiffnessMatrix",
         "dampingMatrix", "nonlinearStiffnessMatrixOfFirstOrderArray", "nonlinearStiffnessMatrixOfSecondOrderArray",
         "nodeNumbers", "nodalRelativePositionArray", "nodalShapeMatrixOfTranslationArray",
         "nodalShapeMatrixOfRotationArray", "stateDependentTranslation", "stateDependentRotation", "frames", "contours"]


def mbsim_value(element):
    """xmlVector and xmlMatrix; arrays of them as one array."""
    if len(element) == 0:
        return float(element.text)
    inner = element[0]
    if inner.tag == VALUE + "xmlVector":
        return np.array([float(each.text) for each in inner])
    if inner.tag == VALUE + "xmlMatrix":
        return np.array([[float(each.text) for each in row] for row in inner])
    assert all(each.tag in (BODY + "ele", BODY + "row") for each in element)
    return np.array([mbsim_value(each) if each.tag == BODY + "ele" else [mbsim_value(one) for one in each]
                     for each in element])


def mbsim(path):
    """Name of the element -> value; frames as name -> node number."""
    root = xml.parse(path).getroot()
    assert root.tag == BODY + "FlexibleFfrBody"
    names = [each.tag.removeprefix(BODY) for each in root]
    assert names == [name for name in ORDER if name in names], names
    found = {"name": root.get("name")}
    for name, element in zip(names, root):
        if name == "frames":
            found[name] = {each.get("name"): int(each.find(BODY + "nodeNumber").text) for each in element}
        elif name.startswith("stateDependent"):
            found[name] = element[0].tag
        elif name != "contours":
            found[name] = mbsim_value(element)
    return found
