// SPDX-License-Identifier: Apache-2.0
using NUnit.Framework;

namespace Furrow.Tests
{
    public sealed class CoreTests
    {
        [Test]
        public void PropertiesHaveLettersAndDigitsOnly()
        {
            Assert.AreEqual("furrow_brow_l_squash", Names.Property("brow_l.squash"));
            Assert.AreEqual("furrow_br_u_2", Names.Property("br\u00e4u-2"));
        }

        [Test]
        public void WeightsArriveInTheOrderOfTheShader()
        {
            var order = new WeightOrder();
            order.Set(new[] { "c", "missing", "a" }, new[] { "a", "b", "c" });
            Assert.AreEqual(3, order.Count);
            float[] arranged = order.Arrange(new[] { 0.25f, 0.5f, 1f });
            Assert.AreEqual(1f, arranged[0]);
            Assert.AreEqual(0f, arranged[1]);
            Assert.AreEqual(0.25f, arranged[2]);
            Assert.AreEqual(true, order.Uses(0));
            Assert.AreEqual(false, order.Uses(1));
        }

        [Test]
        public void TakesAreLinearBetweenFramesAndHeldAtTheEnds()
        {
            var times = new[] { 0f, 1f, 3f };
            var values = new[] { 0f, 1f, 0.5f, 0f, 1f, 0.5f };
            var output = new float[2];
            Take.Sample(times, values, 2f, output);
            Assert.AreEqual(0.75f, output[0]);
            Assert.AreEqual(0.25f, output[1]);
            Take.Sample(times, values, -1f, output);
            Assert.AreEqual(0f, output[0]);
            Assert.AreEqual(1f, output[1]);
            Take.Sample(times, values, 9f, output);
            Assert.AreEqual(1f, output[0]);
            Take.Sample(new float[0], new float[0], 0f, output);
            Assert.AreEqual(0f, output[0]);
        }

        [Test]
        public void InvalidAddressesAreExplained()
        {
            try
            {
                new Connection("http://127.0.0.1");
            }
            catch (FurrowException error)
            {
                Assert.AreEqual(true, error.Message.Contains("furrow://"));
                return;
            }
            Assert.Fail("no exception");
        }
    }
}
