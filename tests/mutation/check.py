"""What may be mutated, and into what: on lines whose mutants are written out."""
import mutants


def of(text):
    return {m.of(text) for choices in mutants.mutants_of(text) for m in choices}


def expect(text, *wanted):
    assert of(text) == set(wanted), f"{text!r}: {sorted(of(text) ^ set(wanted))} are missing or too many"


def main():
    expect("return a < b;", "return a <= b;", "return a >= b;")
    expect("return a == b || !c;", "return a != b || !c;", "return a == b && !c;", "return a == b || c;")
    expect("return -a + b[7];", "return a + b[7];", "return -a - b[7];", "return -a + b[6];", "return -a + b[8];")
    expect("return a[1];", "return a[0];", "return a[2];")
    expect("return 0. + 2.5;", "return 1. + 2.5;", "return 0. - 2.5;")
    expect("return std::min(a, 1);", "return std::max(a, 1);", "return std::min(a, 0);", "return std::min(a, 2);")
    expect("if (a) b.c(d);", "if (!(a)) b.c(d);", "if (a)       ;")
    expect("if (const int a = f(); a) return true;", "if (const int a = f(); a) return false;")
    expect("{ a += f(\n b); }", "{ a -= f(\n b); }", "{" + 8 * " " + "\n" + 3 * " " + "; }")
    expect("for (int i = 3; i != n; ++i) a[i] = {};", "for (int i = 2; i != n; ++i) a[i] = {};",
           "for (int i = 4; i != n; ++i) a[i] = {};", "for (int i = 3; i == n; ++i) a[i] = {};",
           "for (int i = 3; i != n; --i) a[i] = {};", "for (int i = 3; i != n; ++i)          ;")
    for text, wanted in (("int n = 1;\n  MPI_Comm_size(comm, &n);", True), ("PetscInt a = 0, n = 1;\n  check(VecGetSize(x.get(), &n));", True),
                         ("int n = 1;\n  f(n, g(&n));", False), ("int n = 1;\n  MPI_Allreduce(MPI_IN_PLACE, &n, 1, t, op, comm);", False),
                         ("int n = 1;\n  for (; n < 3;) MPI_Comm_size(comm, &n);", False),
                         ("int n = 1;\n  if (some) MPI_Comm_size(comm, &n);", False)):
        number = text.index("n = 1") + 4
        assert mutants.overwritten(text, mutants.Mutant(number, number + 1, "2", "constant")) == wanted, text
    # not: comments, strings, includes, types, messages, what deletes files or starts programs, a function's body
    for text in ("// a < b", "/* a\n + 1 */", '#include "a/b-1.h"', '#if A > 1 && \\\n  B\n', 'R"x(a + 1)")x"', "'+'",
                 "std::vector<int>&& a", "const double* b = &c;", "double a[3];", "Matrix<double, 6, 6> a;", 'return "a" + b + "c";', "f(double a) { }",
                 'throw InputError(fmt::format("{}", a + 1));', "{ fs::remove(a + 1); }", "return std::system(a, 0);"):
        expect(text)
    print("mutants: as they are written out")


if __name__ == "__main__":
    main()
