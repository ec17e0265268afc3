// SPDX-License-Identifier: GPL-3.0-or-later

#include "BandPreconditioner.H"

#include <vector>

// LAPACK's Cholesky factors of a band matrix, and the solution by them (Anderson et al., LAPACK Users' Guide)
extern "C" {
void dpbtrf_(
    const char* triangle, const int* size, const int* width, double* band, const int* stride, int* info
);
void dpbtrs_(
    const char* triangle, const int* size, const int* width, const int* columns, const double* band,
    const int* stride, double* values, const int* length, int* info
);
}

namespace
{

//- The last matrix and its factors
class BandFactors
{
    scalarField diagonal_, upper_;
    double sign_ = 1; // of the diagonal: LAPACK wants it positive, that of the pressure is negative
    int size_ = 0, width_ = 0, failed_ = 1;
    std::vector<double> band_; // columns from the diagonal down

    int stride() const { return width_ + 1; }

    double& entry(int row, int column) { return band_[size_t(column) * stride() + (row - column)]; }

public:

    //- Factorize a matrix, unless it is the last one, as in a step's second corrector
    void factorize(const lduMatrix& matrix)
    {
        if (diagonal_ == matrix.diag() && upper_ == matrix.upper()) return;
        diagonal_ = matrix.diag();
        upper_ = matrix.upper();
        sign_ = !diagonal_.empty() && diagonal_[0] < 0 ? -1 : 1;
        size_ = diagonal_.size();
        width_ = bedFoam::bandWidth(matrix.lduAddr());
        band_.assign(size_t(size_) * stride(), 0);
        const labelUList& row = matrix.lduAddr().upperAddr();
        const labelUList& column = matrix.lduAddr().lowerAddr();
        forAll(diagonal_, cell) entry(cell, cell) = sign_ * diagonal_[cell];
        forAll(upper_, face) entry(row[face], column[face]) = sign_ * upper_[face];
        const int ld = stride();
        dpbtrf_("L", &size_, &width_, band_.data(), &ld, &failed_);
    }

    //- Replace a right-hand side by the solution; without factors it stays, and the solver goes on plainly
    void solve(solveScalarField& values) const
    {
        if (failed_) return;
        const int ld = stride(), columns = 1;
        int info;
        dpbtrs_("L", &size_, &width_, &columns, band_.data(), &ld, values.begin(), &size_, &info);
        values *= sign_;
    }
};

//- OpenFOAM's solvers of symmetric matrices take it by its name, `band`
class BandPreconditioner : public lduMatrix::preconditioner
{
    static BandFactors factors_; // outlives a solver, which is made anew for each corrector

public:

    TypeName("band");

    BandPreconditioner(const lduMatrix::solver& solver, const dictionary&) : lduMatrix::preconditioner(solver)
    {
        factors_.factorize(solver.matrix());
    }

    void precondition(solveScalarField& wA, const solveScalarField& rA, const direction) const override
    {
        wA = rA;
        factors_.solve(wA);
    }
};

BandFactors BandPreconditioner::factors_;
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
