// SPDX-License-Identifier: GPL-3.0-or-later

#include "BandFactor.H"

#include <algorithm>

void bedFoam::BandFactor::reset(int size, int width)
{
    size_ = size;
    width_ = width;
    columns_.assign((size + width + panel) * stride(), 0);
    for (int j = size; j < size + panel; ++j) entry(j, j) = 1;
}

void bedFoam::BandFactor::eliminate(int j, int target, double inverse)
{
    const double* const source = column(j) + (target - j);
    double* const __restrict__ into = column(target);
    const double factor = source[0] * inverse;
    for (int k = 0; k <= width_ + j - target; ++k) into[k] -= factor * source[k];
}

void bedFoam::BandFactor::factorize()
{
    for (int j = 0; j < size_; j += panel)
    {
        double inverse[panel];
        for (int p = 0; p < panel; ++p)
        {
            for (int before = 0; before < p; ++before) eliminate(j + before, j + p, inverse[before]);
            inverse[p] = 1 / column(j + p)[0];
        }
        for (int m = panel; m < width_ + panel; ++m)
        {
            double* const __restrict__ into = column(j + m);
            const double* source[panel];
            double factor[panel];
            for (int p = 0; p < panel; ++p)
            {
                source[p] = column(j + p) + (m - p);
                factor[p] = source[p][0] * inverse[p];
            }
            for (int k = 0; k < width_ + panel - m; k += lanes)
                for (int n = k; n < k + lanes; ++n)
                {
                    into[n] -= factor[0] * source[0][n] + factor[1] * source[1][n] + factor[2] * source[2][n]
                        + factor[3] * source[3][n];
                }
        }
        for (int p = 0; p < panel; ++p)
        {
            double* const lower = column(j + p);
            for (int m = 1; m <= width_; ++m) lower[m] *= inverse[p];
            lower[0] = inverse[p];
        }
    }
}

void bedFoam::BandFactor::solve(double* values) const
{
    for (int j = 0; j < size_; ++j)
    {
        const double* const lower = column(j);
        double* const __restrict__ below = values + j;
        const double value = below[0];
        const int reach = std::min(width_, size_ - 1 - j);
        for (int m = 1; m <= reach; ++m) below[m] -= lower[m] * value;
    }
    for (int j = size_ - 1; j >= 0; --j)
    {
        const double* const lower = column(j);
        const double* const below = values + j;
        const int reach = std::min(width_, size_ - 1 - j);
        // Several sums side by side: one alone waits for each of its additions
        double sums[lanes] = {};
        int m = 1;
        for (; m + lanes <= reach + 1; m += lanes)
            for (int n = 0; n < lanes; ++n) sums[n] += lower[m + n] * below[m + n];
        for (; m <= reach; ++m) sums[0] += lower[m] * below[m];
        values[j] = values[j] * lower[0] - ((sums[0] + sums[1]) + (sums[2] + sums[3]));
    }
}
