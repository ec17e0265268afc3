// SPDX-License-Identifier: GPL-3.0-or-later
// Solves a symmetric band system from standard input: size, width, its entries by column from the diagonal
// down (width + 1 each), right-hand side. Prints the solution.

#include <cstdio>
#include <iostream>
#include <vector>

#include "BandFactor.H"

int main()
{
    int size, width;
    std::cin >> size >> width;
    bedFoam::BandFactor factor;
    factor.reset(size, width);
    for (int column = 0; column < size; ++column)
        for (int row = column; row <= column + width; ++row)
        {
            double value;
            std::cin >> value;
            if (row < size) factor.entry(row, column) = value;
        }
    std::vector<double> values(size);
    for (double& value : values) std::cin >> value;
    factor.factorize();
    factor.solve(values.data());
    for (const double value : values) std::printf("%.17g\n", value);
}
