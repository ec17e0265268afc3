// SPDX-License-Identifier: GPL-3.0-or-later

#include "BandPreconditioner.H"

#include "BandFactor.H"

namespace
{

//- The last matrix and its factors
struct KeptFactor
{
    scalarField diagonal, upper;
    bedFoam::BandFactor factor;
};

//- Factors of a matrix: those of the last one where it is the same, as in a step's second corrector
const bedFoam::BandFactor& factorOf(const lduMatrix& matrix)
{
    static KeptFactor kept;
    if (kept.diagonal == matrix.diag() && kept.upper == matrix.upper()) return kept.factor;
    kept.diagonal = matrix.diag();
    kept.upper = matrix.upper();

    const labelUList& row = matrix.lduAddr().upperAddr();
    const labelUList& column = matrix.lduAddr().lowerAddr();
    kept.factor.reset(kept.diagonal.size(), bedFoam::bandWidth(matrix.lduAddr()));
    forAll(kept.diagonal, cell) kept.factor.entry(cell, cell) = kept.diagonal[cell];
    forAll(row, face) kept.factor.entry(row[face], column[face]) = kept.upper[face];
    kept.factor.factorize();
    return kept.factor;
}

//- OpenFOAM's solvers of symmetric matrices take it by its name, `band`
class BandPreconditioner : public lduMatrix::preconditioner
{
    const bedFoam::BandFactor& factor_;

public:

    TypeName("band");

    BandPreconditioner(const lduMatrix::solver& solver, const dictionary&)
        : lduMatrix::preconditioner(solver),
          factor_(factorOf(solver.matrix()))
    {}

    void precondition(solveScalarField& wA, const solveScalarField& rA, const direction) const override
    {
        wA = rA;
        factor_.solve(wA.begin());
    }
};

defineTypeNameAndDebug(BandPreconditioner, 0);
lduMatrix::preconditioner::addsymMatrixConstructorToTable<BandPreconditioner> addBandPreconditioner;

}

label bedFoam::bandWidth(const lduAddressing& addressing)
{
    const labelUList& upper = addressing.upperAddr();
    const labelUList& lower = addressing.lowerAddr();
    label width = 0;
    forAll(upper, face) width = max(width, upper[face] - lower[face]);
    return width;
}
