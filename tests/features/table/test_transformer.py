"""The scikit-learn transformer passes the checks of scikit-learn and computes the features of the feature table."""

import numpy as np
from sklearn import config_context
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import make_pipeline
from sklearn.utils.estimator_checks import parametrize_with_checks

from features.table.indicators import Orders, feature_names, indicators
from features.table.transformer import IndicatorTransformer
from tests.pulses import pulse_train

FAST = {"fs": 3000.0, "shaft_rate": 400.0}  # at this speed the few samples of the checks are several revolutions


@parametrize_with_checks(
    [
        IndicatorTransformer(groups=("time", "bands")),
        IndicatorTransformer(**FAST, groups=("lines", "shape"), speed="correct"),
    ]
)
def test_the_transformer_passes_the_checks_of_scikit_learn(estimator, check):
    check(estimator)


def test_the_transformer_computes_the_indicators():
    x = np.random.default_rng(0).standard_normal((3, 6000))
    orders = Orders(*(np.full(3, order) for order in (0.4, 3.6, 5.4, 2.4)))
    expected, names = indicators(x, 12_800.0, np.full(3, 25.0), orders, ("shape", "lines"))
    transformer = IndicatorTransformer(12_800.0, 25.0, 0.4, 3.6, 5.4, 2.4, ("shape", "lines"))
    np.testing.assert_array_equal(transformer.fit_transform(x), expected)
    assert tuple(transformer.get_feature_names_out()) == names


def test_a_pipeline_passes_the_shaft_rate_of_each_signal():
    x, rates = np.random.default_rng(0).standard_normal((6, 6000)), np.linspace(20.0, 30.0, 6)
    transformer = IndicatorTransformer(groups=("bands",)).set_output(transform="pandas")
    with config_context(enable_metadata_routing=True):
        pipeline = make_pipeline(transformer.set_transform_request(shaft_rate=True), LogisticRegression())
        pipeline.fit(x, np.arange(6) % 2, shaft_rate=rates)
    found = transformer.transform(x, rates)
    expected = [transformer.transform(row[None], rate).iloc[0] for row, rate in zip(x, rates, strict=True)]
    np.testing.assert_array_equal(found, expected)
    assert tuple(found.columns) == feature_names(("bands",))
    assert (pipeline[-1].n_features_in_, found.columns[0]) == (found.shape[1], pipeline[:-1].get_feature_names_out()[0])


def test_a_wrong_speed_is_corrected_signal_by_signal():
    rates = (28.6, 30.0)
    rng = np.random.default_rng(1)
    x = np.array([pulse_train(12_000.0, 3.0, 3.5848 * rate, 3000.0, rng, noise=0.1) for rate in rates])
    comb = feature_names(("lines",)).index("whitened_bpfo_comb")

    def combs(**options):
        return IndicatorTransformer(groups=("lines",), **options).fit_transform(x)[:, comb]

    right = [combs(shaft_rate=rate)[number] for number, rate in enumerate(rates)]
    np.testing.assert_allclose(combs(speed="correct"), right, atol=0.2)
    assert combs()[0] < right[0] - 1
